// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/printable.h"

#include <fmt/format.h>
#include <malloc.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/Prune.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>

#include "worker/export/fill_slivers.h"
#include "worker/export/keep_wall.h"
#include "worker/export/strut_level_set.h"
#include "worker/export/thin_out.h"
#include "worker/export/untangle.h"
#include "worker/frame/disjoint_sets.h"
#include "worker/skin/distance_grids.h"
#include "worker/skin/level_set.h"
#include "worker/skin/mend_edges.h"
#include "worker/skin/triangle_tree.h"
#include "worker/solid/solid.h"

namespace skinframe {
namespace {

constexpr double kBandVoxels = 3.0;
constexpr double kMaxSurfaceSquares = 3e6;  // as in build_skin.cpp: some 600 MB while the grid is made
constexpr double kFlatBandVoxels = 8.0;     // of the band beside the skin's own depth
constexpr double kMaxBandVoxels = 3e6 * 24;
constexpr double kVoxelInRadii = 0.6;      // of the thinnest strut
constexpr double kThinningInVoxels = 0.1;  // root mean square over planes

Result<double> choose_voxel(const ExportOptions& options, const Skin& skin,
                            const std::vector<double>& radii_mm, double area_mm2) {
  // The band about M is deeper, in voxels, the smaller they are; its volume is what memory is taken for.
  double least = std::sqrt(area_mm2 / kMaxSurfaceSquares);
  while (area_mm2 / (least * least) * (skin.thickness_mm / least + kFlatBandVoxels) > kMaxBandVoxels)
    least *= 1.05;
  double thinnest = 0.5 * skin.thickness_mm;
  if (!radii_mm.empty()) thinnest = *std::min_element(radii_mm.begin(), radii_mm.end());
  // A coarser grid than that breaks struts into beads.
  const double most = std::max(least, kVoxelInRadii * thinnest);
  const double voxel = options.voxel_mm.value_or(most);
  if (voxel < least * (1.0 - 1e-9) || voxel > most * (1.0 + 1e-9) || least > skin.thickness_mm) {
    return invalid_input(fmt::format(
        "an export grid of {:.3g} mm on a surface of {:.0f} mm2 with struts of radius {:.3g} mm: use a "
        "--voxel between {:.3g} and {:.3g} mm{}",
        voxel, area_mm2, thinnest, least, most, voxel < most ? " or a smaller --size" : ""));
  }
  return voxel;
}

// Seconds since the last step, under its name.
class Steps {
 public:
  explicit Steps(std::map<std::string, double>* seconds) : seconds_(seconds) {}
  void done(const char* step) {
    const auto now = std::chrono::steady_clock::now();
    (*seconds_)[step] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::map<std::string, double>* seconds_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// The narrow band of M1 from the distance to M, or the larger one to M and its smooth copy: distance + h_S,
// clamped.
openvdb::FloatGrid::Ptr m1_level_set(const TriangleMesh& mesh, const Skin& skin, double voxel, double band) {
  openvdb::FloatGrid::Ptr grid;
  if (skin.field.grids() != nullptr && skin.field.grids()->voxel_mm == voxel) {
    grid = skin.field.grids()->fine->deepCopy();
  } else {
    const double inner = std::ceil(skin.thickness_mm / voxel) + kBandVoxels + 1.0;
    grid = distance_grid(mesh, voxel, kBandVoxels + 1.0, inner);
    if (skin.smoothing && skin.smoothing->applied)
      openvdb::tools::compMax(*grid, *distance_grid(skin.smoothing->copy, voxel, kBandVoxels + 1.0, inner));
  }
  const float limit = static_cast<float>(band);
  for (auto it = grid->beginValueAll(); it; ++it) {
    const float value = *it + static_cast<float>(skin.thickness_mm);
    if (value >= limit || value <= -limit) {
      it.setValue(std::clamp(value, -limit, limit));
      it.setActiveState(false);
    } else {
      it.setValue(value);
    }
  }
  openvdb::tools::changeBackground(grid->tree(), limit);
  openvdb::tools::pruneLevelSet(grid->tree());
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  return grid;
}

// Grids are millions of small pieces, which the allocator keeps for others of their size when they go; what
// comes next are a few large ones.
void return_free_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

// Closed shells too small to matter: pockets of the cavity (counted) and crumbs of solid floating in it.
void drop_small_shells(TriangleMesh& cavity, double smallest_mm3, PrintableMesh& result) {
  DisjointSets shells(cavity.vertices.size());
  for (const auto& [a, b, c] : cavity.triangles) {
    shells.unite(a, b);
    shells.unite(b, c);
  }
  std::vector<double> volumes(cavity.vertices.size(), 0.0);  // each at one vertex of its shell
  for (const auto& [a, b, c] : cavity.triangles) {
    const Eigen::Vector3d &p = cavity.vertices[a], &q = cavity.vertices[b], &r = cavity.vertices[c];
    volumes[shells.find(a)] += p.dot(q.cross(r)) / 6.0;
  }
  for (const double volume : volumes) {
    if (std::abs(volume) >= smallest_mm3)
      result.pockets += volume > 0.0;
    else
      result.pockets_filled += volume > 0.0;
  }
  std::erase_if(cavity.triangles,
                [&](const auto& t) { return std::abs(volumes[shells.find(t[0])]) < smallest_mm3; });
  drop_unused_vertices(cavity);
}

struct Cavity {
  TriangleMesh surface;  // outward
  int crossings_left = 0;
};

// careful: collapses that would make triangles meet are refused, which takes half as long again.
Result<Cavity> make_cavity(const TriangleMesh& mesh, const Skin& skin, const Frame& frame,
                           const std::vector<double>& radii_mm, const ExportOptions& options, bool careful,
                           const RunContext& context, PrintableMesh& result) {
  Steps steps(&result.seconds);
  const double voxel = result.voxel_mm, band = kBandVoxels * voxel;
  auto cavity_grid = m1_level_set(mesh, skin, voxel, band);
  if (context.cancelled()) return cancelled_error();
  steps.done("offset");
  auto struts = strut_level_set(frame, radii_mm, voxel, band);
  if (context.cancelled()) return cancelled_error();
  openvdb::tools::csgDifference(*cavity_grid, *struts);
  struts.reset();
  return_free_memory();
  fill_slivers(*cavity_grid);
  steps.done("struts");
  TriangleMesh cavity = iso_surface(std::move(cavity_grid), 0.0);
  return_free_memory();
  if (context.cancelled()) return cancelled_error();

  drop_small_shells(cavity, options.smallest_pocket_mm3, result);
  bool manifold = mend_edges(cavity).manifold;
  if (context.cancelled()) return cancelled_error();
  steps.done("surface");
  if (manifold && options.max_triangles > 0) {
    ThinningOptions thinning;
    thinning.triangles = options.max_triangles;
    thinning.max_deviation_mm = kThinningInVoxels * voxel;
    thinning.is_bounded = false;
    thinning.is_clear = careful;
    thin_out(cavity, thinning, context);
  }
  steps.done("thin_out");
  const TriangleTree body(mesh);
  keep_wall(cavity, body, skin, voxel);
  manifold = manifold && mend_edges(cavity).manifold;  // places rounded to float may fall together
  if (context.cancelled()) return cancelled_error();
  steps.done("keep_wall");
  // What is taken apart keeps the wall too. Where the cavity is a sliver its sides have no room to part, so
  // the wall gives way there round by round, to less than half a voxel.
  const auto hold = [&](Eigen::Vector3d& vertex, int round) {
    const double slack = kWallSlackInVoxels * (2.0 + 2.0 * round / kMostUntanglingRounds);
    const double least = skin.thickness_mm - slack * voxel;
    keep_wall(vertex, body, least, least);
  };
  const int crossings_left = untangle(cavity, context, hold).crossings_left;
  if (context.cancelled()) return cancelled_error();
  steps.done("untangle");
  if (!manifold || count_bad_edges(cavity) > 0)
    return internal_error("the boundary of the cavity is not closed: try another --voxel");
  return Cavity{std::move(cavity), crossings_left};
}

Result<PrintableMesh> merge(const TriangleMesh& mesh, const Skin& skin, const Frame& frame,
                            const std::vector<double>& radii_mm, const ExportOptions& options,
                            const RunContext& context) {
  const auto voxel = choose_voxel(options, skin, radii_mm, surface_area(mesh));
  if (!voxel) return voxel.error();
  PrintableMesh result;
  Cavity cavity;
  for (const bool careful : {false, true}) {
    result.pockets = result.pockets_filled = 0;
    result.voxel_mm = *voxel;
    cavity = {};  // before the next is made
    auto made = make_cavity(mesh, skin, frame, radii_mm, options, careful, context, result);
    if (!made) return made.error();
    cavity = std::move(made).value();
    if (cavity.crossings_left == 0) break;
  }
  result.crossings_left = cavity.crossings_left;
  result.cavity_volume_mm3 = signed_volume(cavity.surface);
  result.volume_mm3 = signed_volume(mesh) - result.cavity_volume_mm3;

  Steps steps(&result.seconds);
  result.mesh = mesh;
  for (auto& v : result.mesh.vertices) v = v.cast<float>().cast<double>();
  const int first = static_cast<int>(result.mesh.vertices.size());
  result.mesh.vertices.insert(result.mesh.vertices.end(), cavity.surface.vertices.begin(),
                              cavity.surface.vertices.end());
  result.mesh.triangles.reserve(result.mesh.triangles.size() + cavity.surface.triangles.size());
  for (const auto& t : cavity.surface.triangles)
    result.mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  result.crossings_left += count_cuts_of_surface(result.mesh, mesh.triangles.size(), skin);
  steps.done("cuts");
  return result;
}

}  // namespace

Status ExportOptions::validate() const {
  if (voxel_mm && !(*voxel_mm > 0.0)) return invalid_input("--voxel must be above 0 mm");
  if (!(smallest_pocket_mm3 >= 0.0)) return invalid_input("the smallest pocket must not be below 0 mm3");
  return ok_status();
}

Result<PrintableMesh> merge_solid(const Solid& solid, const Skin& skin, const Frame& frame,
                                  const std::vector<double>& radii_mm, const ExportOptions& options,
                                  RunContext& context) {
  return merge_solid(solid.mesh(), skin, frame, radii_mm, options, context);
}

Result<PrintableMesh> merge_solid(const TriangleMesh& closed_mesh, const Skin& skin, const Frame& frame,
                                  const std::vector<double>& radii_mm, const ExportOptions& options,
                                  RunContext& context) {
  SKINFRAME_CHECK(radii_mm.size() == frame.struts.size());
  if (auto status = options.validate(); !status) return status.error();
  if (context.cancelled()) return cancelled_error();
  try {
    tbb::task_arena arena(std::max(1, context.threads));
    return arena.execute([&] { return merge(closed_mesh, skin, frame, radii_mm, options, context); });
  } catch (const std::bad_alloc&) {
    throw;  // the job ends OUT_OF_MEMORY, not INTERNAL
  } catch (const std::exception& e) {
    return internal_error(fmt::format("the struts could not be merged with the skin: {}", e.what()));
  }
}

}  // namespace skinframe
