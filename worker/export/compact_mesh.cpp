// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/compact_mesh.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <vector>

#include "worker/export/thin_out.h"
#include "worker/export/untangle.h"
#include "worker/skin/mend_edges.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {

constexpr int kMostTries = 2;
constexpr double kFirstTolerance = 0.1;  // root mean square, of the deviation; each try halves it
constexpr std::size_t kMostProbes = 200'000;

TriangleMesh part_of(const TriangleMesh& mesh, std::size_t first, std::size_t last) {
  TriangleMesh part{mesh.vertices, {mesh.triangles.begin() + first, mesh.triangles.begin() + last}};
  drop_unused_vertices(part);
  return part;
}

// Every corner, since whoever checks the deviation looks at corners; and middles of the triangles, evenly
// thinned to kMostProbes.
std::vector<Eigen::Vector3d> probes_of(const TriangleMesh& mesh) {
  const std::size_t stride = 1 + mesh.triangles.size() / kMostProbes;
  std::vector<Eigen::Vector3d> probes = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += stride) {
    const auto& [a, b, c] = mesh.triangles[t];
    probes.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0);
  }
  return probes;
}

double furthest(const std::vector<Eigen::Vector3d>& probes, const TriangleTree& tree) {
  std::vector<double> distance(probes.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, probes.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) distance[i] = tree.distance_mm(probes[i]);
  });
  return distance.empty() ? 0.0 : *std::max_element(distance.begin(), distance.end());
}

// Thinned, closed, without crossings of its own but where untangling leaves some: those are counted.
void thin_part(TriangleMesh& part, std::size_t triangles, double tolerance, CompactMesh& compact,
               const RunContext& context) {
  if (part.triangles.size() <= triangles) return;
  thin_out(part, triangles, tolerance);
  compact.crossings_left += untangle(part, context).crossings_left;
}

}  // namespace

Result<CompactMesh> make_compact(const PrintableMesh& printable, std::size_t outer_triangles,
                                 const CompactOptions& options, const RunContext& context) {
  SKINFRAME_CHECK(outer_triangles <= printable.mesh.triangles.size() && options.max_deviation_mm > 0.0);
  tbb::task_arena arena(std::max(1, context.threads));
  return arena.execute([&]() -> Result<CompactMesh> {
    const TriangleTree full(printable.mesh);
    const auto full_probes = probes_of(printable.mesh);
    double tolerance = kFirstTolerance * options.max_deviation_mm;
    for (int tries = 1;; ++tries) {
      CompactMesh compact;
      TriangleMesh outer = part_of(printable.mesh, 0, outer_triangles);
      TriangleMesh cavity = part_of(printable.mesh, outer_triangles, printable.mesh.triangles.size());
      const bool is_last = tries > kMostTries;  // then it stays as it is
      if (!is_last) {
        thin_part(outer, options.triangles / 2, tolerance, compact, context);
        const std::size_t left = options.triangles - std::min(options.triangles, outer.triangles.size());
        thin_part(cavity, std::max(left, options.triangles / 4), tolerance, compact, context);
      }
      if (context.cancelled()) return cancelled_error();
      compact.outer_triangles = outer.triangles.size();
      compact.mesh = std::move(outer);
      const int first = static_cast<int>(compact.mesh.vertices.size());
      compact.mesh.vertices.insert(compact.mesh.vertices.end(), cavity.vertices.begin(),
                                   cavity.vertices.end());
      for (const auto& t : cavity.triangles)
        compact.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      if (!is_last) {
        compact.deviation_mm = std::max(furthest(probes_of(compact.mesh), full),
                                        furthest(full_probes, TriangleTree(compact.mesh)));
        if (compact.deviation_mm > options.max_deviation_mm) {
          tolerance *= 0.5;
          continue;
        }
      }
      compact.volume_mm3 = signed_volume(compact.mesh);
      return compact;
    }
  });
}

}  // namespace skinframe
