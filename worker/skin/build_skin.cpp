// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/build_skin.h"

#include <fmt/format.h>
#include <openvdb/tools/Composite.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "worker/skin/distance_grids.h"
#include "worker/skin/level_set.h"
#include "worker/skin/mend_edges.h"
#include "worker/solid/solid.h"

namespace skinframe {
namespace {

constexpr double kDefaultVoxelInThicknesses = 0.3;
constexpr double kCoarseCellsAcross =
    200.0;                                // of the largest edge of the box: at most 8 million coarse voxels
constexpr double kLeastCoarseness = 2.0;  // and at least this many fine voxels, on small bodies
constexpr double kOuterVoxels = 3.0;
constexpr double kSpareInnerVoxels = 4.0;
// The fine grid holds some 24 voxels under and over every voxel's square of surface, 8 bytes each while it is
// made: 3 million squares are 600 MB at worst.
constexpr double kMaxSurfaceSquares = 3e6;

Result<double> choose_voxel(const SkinOptions& options, double area_mm2) {
  const double least = std::sqrt(area_mm2 / kMaxSurfaceSquares);
  const double h = options.thickness_mm;
  const double voxel = options.voxel_mm.value_or(std::max(kDefaultVoxelInThicknesses * h, least));
  if (voxel < least * (1.0 - 1e-9) || voxel > h) {
    return invalid_input(
        fmt::format("a surface of {:.0f} mm2 at voxels of {:.3g} mm takes more memory than is granted, or "
                    "voxels coarser than the "
                    "skin of {:.3g} mm: use a --voxel of at least {:.3g} mm (at most the skin's thickness) "
                    "or a smaller --size",
                    area_mm2, std::min(voxel, h), h, least));
  }
  return voxel;
}

Status check_mesh(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return invalid_input("the mesh has no triangles: nothing can be given a skin");
  const double volume = signed_volume(mesh);
  if (!(volume > 0.0) || !std::isfinite(volume)) {
    return invalid_input(
        fmt::format("the mesh encloses {:.3g} mm3: a closed, outward mesh is needed", volume));
  }
  return ok_status();
}

// At each place the larger of the two distances: that of what both surfaces enclose.
openvdb::FloatGrid::Ptr larger(const openvdb::FloatGrid& a, openvdb::FloatGrid& b) {
  auto result = a.deepCopy();
  openvdb::tools::compMax(*result, b);
  return result;
}

// faired: M's copy.
Smoothing smooth_detail(const TriangleMesh& mesh, const TriangleMesh& faired, const DistanceField& field,
                        const SkinOptions& options, const RunContext& context) {
  Smoothing smoothing;
  smoothing.detail = measure_detail(faired, field, options.thickness_mm);
  const bool wanted = options.smooth == Smooth::kOn || smoothing.detail.share >= kLeastDetailShare;
  if (!wanted || faired.triangles.empty() || context.cancelled()) return smoothing;
  smoothing.copy = keep_inside(faired, mesh, field, options.thickness_mm, context).mesh;
  smoothing.applied = true;
  return smoothing;
}

Result<Skin> build(const TriangleMesh& mesh, const SkinOptions& options, const RunContext& context) {
  const auto voxel = choose_voxel(options, surface_area(mesh));
  if (!voxel) return voxel.error();

  auto grids = std::make_shared<DistanceGrids>();
  const BoundingBox box = bounding_box(mesh);
  const double extent = box.extent().maxCoeff();
  grids->voxel_mm = *voxel;
  grids->coarse_voxel_mm = std::max(kLeastCoarseness * *voxel, extent / kCoarseCellsAcross);
  const double inner_voxels = std::ceil(options.thickness_mm / *voxel) + kSpareInnerVoxels;
  grids->inner_band_mm = inner_voxels * *voxel;
  grids->outer_band_mm = kOuterVoxels * *voxel;
  // No point is deeper than half of the box's least edge.
  const double deepest = 0.5 * box.extent().minCoeff() / grids->coarse_voxel_mm + 2.0;
  TriangleMesh faired;
  tbb::parallel_invoke(
      [&] { grids->fine = distance_grid(mesh, *voxel, kOuterVoxels, inner_voxels); },
      [&] { grids->coarse = distance_grid(mesh, grids->coarse_voxel_mm, kOuterVoxels, deepest); },
      [&] {
        if (options.smooth != Smooth::kOff) faired = fair_surface(mesh, options.thickness_mm, *voxel);
      });
  if (context.cancelled()) return cancelled_error();
  const DistanceField body_field(grids);

  Skin skin;
  double plain_cavity_mm3 = 0.0;
  if (options.smooth != Smooth::kOff) {
    skin.smoothing = smooth_detail(mesh, faired, body_field, options, context);
    if (context.cancelled()) return cancelled_error();
    faired = {};
  }
  if (skin.smoothing && skin.smoothing->applied) {
    const TriangleMesh& copy = skin.smoothing->copy;
    auto cut = std::make_shared<DistanceGrids>(*grids);
    cut->fine = larger(*grids->fine, *distance_grid(copy, *voxel, kOuterVoxels, inner_voxels));
    cut->coarse = larger(*grids->coarse, *distance_grid(copy, grids->coarse_voxel_mm, kOuterVoxels, deepest));
    plain_cavity_mm3 = signed_volume(iso_surface(*grids->fine, -options.thickness_mm));
    grids = std::move(cut);
    if (context.cancelled()) return cancelled_error();
  }
  skin.thickness_mm = options.thickness_mm;
  skin.voxel_mm = *voxel;
  skin.plate_z_mm = box.min.z();
  skin.body_box_mm = box;
  const double volume = signed_volume(mesh);
  Eigen::Vector3d moment = volume * volume_centroid(mesh);
  const DistanceField field(grids);
  bool is_closed = false;
  tbb::parallel_invoke(
      [&] {
        const TriangleMesh cavity = iso_surface(*grids->fine, -options.thickness_mm);
        if (cavity.triangles.empty()) return;
        skin.cavity_volume_mm3 = std::clamp(signed_volume(cavity), 0.0, volume);
        if (skin.cavity_volume_mm3 > 0.0) moment -= skin.cavity_volume_mm3 * volume_centroid(cavity);
      },
      [&] {
        skin.inner_surface = iso_surface(*grids->coarse, -options.thickness_mm);
        is_closed = mend_edges(skin.inner_surface).manifold;
        if (!skin.smoothing || !skin.smoothing->applied)
          skin.sharp_edges = find_sharp_edges(mesh, field, options.thickness_mm);
      },
      [&] { skin.thin = find_thin_parts(mesh, body_field, options.thickness_mm, context); });
  if (context.cancelled()) return cancelled_error();
  if (!is_closed) return internal_error("the inner surface of the skin is not closed: try another --voxel");
  skin.field = field;
  skin.volume_mm3 = volume - skin.cavity_volume_mm3;
  if (skin.smoothing && skin.smoothing->applied)
    skin.smoothing->added_skin_mm3 = std::max(0.0, plain_cavity_mm3 - skin.cavity_volume_mm3);
  if (skin.volume_mm3 > 0.0) skin.centroid_mm = moment / skin.volume_mm3;
  if (skin.is_thin_everywhere()) skin.thin = {volume, 1.0, 0, {}};
  return skin;
}

}  // namespace

bool Skin::is_thin_everywhere() const {
  return inner_surface.triangles.empty() ||
         cavity_volume_mm3 < kLeastHollowShare * (volume_mm3 + cavity_volume_mm3);
}

Status SkinOptions::validate() const {
  if (!(thickness_mm > 0.0) || !std::isfinite(thickness_mm)) {
    return invalid_input(fmt::format("skin thickness {:.3g} mm: must be above 0", thickness_mm));
  }
  if (voxel_mm && !(*voxel_mm >= thickness_mm / 20.0 && *voxel_mm <= thickness_mm)) {
    return invalid_input(
        fmt::format("--voxel {:.3g} mm: must lie between {:.3g} and {:.3g} mm, a twentieth of the "
                    "skin's thickness and all of it",
                    *voxel_mm, thickness_mm / 20.0, thickness_mm));
  }
  return ok_status();
}

Result<Skin> build_skin(const Solid& solid, const SkinOptions& options, RunContext& context) {
  return build_skin(solid.mesh(), options, context);
}

Result<Skin> build_skin(const TriangleMesh& closed_mesh, const SkinOptions& options, RunContext& context) {
  if (auto status = options.validate(); !status) return status.error();
  if (auto status = check_mesh(closed_mesh); !status) return status.error();
  if (context.cancelled()) return cancelled_error();
  try {
    tbb::task_arena arena(std::max(1, context.threads));
    return arena.execute([&] {
      auto skin = build(closed_mesh, options, context);
      if (!skin || !skin->smoothing || !skin->smoothing->applied || !skin->is_thin_everywhere()) return skin;
      // Smoothing must not be what makes a body solid.
      SkinOptions plain = options;
      plain.smooth = Smooth::kOff;
      auto unsmoothed = build(closed_mesh, plain, context);
      if (unsmoothed) unsmoothed.value().smoothing = Smoothing{skin->smoothing->detail, false, 0.0, {}};
      return unsmoothed;
    });
  } catch (const std::bad_alloc&) {
    throw;  // the job ends OUT_OF_MEMORY, not INTERNAL
  } catch (const std::exception& e) {
    return internal_error(fmt::format("the skin could not be made: {}", e.what()));
  }
}

}  // namespace skinframe
