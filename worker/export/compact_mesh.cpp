// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/compact_mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "worker/export/crossings.h"
#include "worker/export/thin_out.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {

constexpr int kMostTries = 3;        // then it stays as it is
constexpr double kFirstShare = 0.9;  // of the deviation that is allowed,
constexpr double kLessShare = 0.7;   // and in each further try of the one before
constexpr double kFewOuter = 0.25;   // of the triangles wanted: M as it is

int end_of_vertices(const TriangleMesh& mesh, std::size_t triangles) {
  int end = 0;
  for (std::size_t t = 0; t < triangles; ++t)
    for (int v : mesh.triangles[t]) end = std::max(end, v + 1);
  return end;
}

// Furthest of the mesh's corners and of the middles of its triangles.
double furthest(const TriangleMesh& mesh, const TriangleTree& tree) {
  const auto probe = [&](std::size_t i) -> Eigen::Vector3d {
    if (i < mesh.vertices.size()) return mesh.vertices[i];
    const auto& [a, b, c] = mesh.triangles[i - mesh.vertices.size()];
    return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0;
  };
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, mesh.vertices.size() + mesh.triangles.size(), 1024), 0.0,
      [&](const auto& range, double most) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          if (!tree.is_within(probe(i), most)) most = tree.distance_mm(probe(i));
        return most;
      },
      [](double x, double y) { return std::max(x, y); });
}

}  // namespace

Result<CompactMesh> make_compact(const PrintableMesh& printable, std::size_t outer_triangles,
                                 const CompactOptions& options, const RunContext& context) {
  SKINFRAME_CHECK(outer_triangles <= printable.mesh.triangles.size() && options.max_deviation_mm > 0.0);
  tbb::task_arena arena(std::max(1, context.threads));
  return arena.execute([&]() -> Result<CompactMesh> {
    CompactMesh compact;
    ThinningOptions thinning;
    thinning.triangles = options.triangles;
    thinning.exact_stay = outer_triangles <= kFewOuter * options.triangles;
    thinning.max_deviation_mm = kFirstShare * options.max_deviation_mm;
    std::optional<TriangleTree> full;
    if (printable.mesh.triangles.size() > options.triangles) full.emplace(printable.mesh);
    thinning.original = full ? &*full : nullptr;
    for (int tries = 0;; ++tries) {
      compact.mesh = printable.mesh;
      thinning.exact_vertices = end_of_vertices(compact.mesh, outer_triangles);
      const bool stays = tries == kMostTries || compact.mesh.triangles.size() <= options.triangles;
      if (stays) {
        compact.outer_triangles = outer_triangles;
        compact.deviation_mm = 0.0;
        break;
      }
      const Thinned thinned = thin_out(compact.mesh, thinning, context);
      if (context.cancelled()) return cancelled_error();
      compact.outer_triangles = std::count_if(compact.mesh.triangles.begin(), compact.mesh.triangles.end(),
                                              [&](const auto& t) { return t[0] < thinned.exact_vertices; });
      compact.deviation_mm = std::max(thinned.deviation_mm, furthest(compact.mesh, *full));
      if (compact.deviation_mm <= options.max_deviation_mm) break;
      thinning.max_deviation_mm *= kLessShare;
    }
    full.reset();
    if (context.cancelled()) return cancelled_error();
    for (const auto& [s, t] : crossing_triangles(compact.mesh))
      compact.crossings_left += static_cast<std::size_t>(std::max(s, t)) >= compact.outer_triangles;
    compact.volume_mm3 = signed_volume(compact.mesh);
    return compact;
  });
}

}  // namespace skinframe
