// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/repair.h"

#include <fmt/format.h>

#include <exception>
#include <new>

#include "worker/solid/last_resort.h"
#include "worker/solid/repair_steps.h"
#include "worker/solid/unite.h"
#include "worker/solid/weld.h"

namespace skinframe {
namespace {

Status check_input(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return invalid_input("the mesh holds no triangle");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite())
      return invalid_input(fmt::format("vertex {}: a coordinate is not finite", v));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v >= 0 && static_cast<std::size_t>(v) < mesh.vertices.size()) continue;
      return invalid_input(fmt::format("triangle {}: index {} of {} vertices", t, v, mesh.vertices.size()));
    }
  }
  return ok_status();
}

// What a union or a wrap left: closed already, but for edges where it touches itself.
Result<Solid> close_again(TriangleMesh mesh, double diagonal, Sentences& repairs) {
  Sentences ours;  // of touching edges that we made ourselves nobody needs to know
  weld(mesh, 0);
  drop_degenerate(mesh);
  drop_duplicates(mesh);
  bool senses_kept = true, large_opening = false;
  if (Status s = straighten(mesh, diagonal, senses_kept, ours); !s.ok()) return s.error();
  if (!senses_kept) return internal_error("a union lost its orientation");
  return close(std::move(mesh), RepairOptions{}, diagonal, true, large_opening, repairs);
}

Result<RepairOutcome> unite(Solid solid, const RepairOptions& options, double diagonal, Sentences repairs,
                            Sentences warnings, RunContext& context) {
  if (!options.unite_overlaps)
    return RepairOutcome{std::move(solid), std::move(repairs), std::move(warnings)};
  for (const bool exact : {true, false}) {
    auto united = skinframe::unite_overlaps(solid.mesh(),
                                            UniteOptions{options.max_self_overlap_relative, exact}, context);
    if (!united.ok()) return united.error();
    Union& result = united.value();
    Sentences told = repairs;
    told.insert(told.end(), result.repairs.begin(), result.repairs.end());
    if (result.changed) {
      auto closed = close_again(std::move(result.mesh), diagonal, told);
      if (!closed.ok()) continue;  // rounded to floats, the exact union may be torn: then by a level set
      solid = std::move(closed).value();
    }
    warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
    return RepairOutcome{std::move(solid), std::move(told), std::move(warnings)};
  }
  warnings.push_back(
      "bodies that overlap could not be united; accepted as they are, so volumes count the overlap twice");
  return RepairOutcome{std::move(solid), std::move(repairs), std::move(warnings)};
}

Result<RepairOutcome> run_chain(TriangleMesh mesh, const RepairOptions& options, RunContext& context) {
  Sentences repairs, warnings;
  const double diagonal = bounding_box(mesh).extent().norm();
  if (!(diagonal > 0)) return invalid_input("the mesh has no extent: all its vertices coincide");

  weld_until_closed(mesh, options, diagonal, repairs);
  if (mesh.triangles.empty())
    return invalid_input("the mesh encloses no volume: every triangle is collapsed");
  stitch(mesh, diagonal, repairs);
  remove_duplicates(mesh, repairs);
  if (context.cancelled()) return cancelled_error();

  TriangleMesh straight = mesh;
  Sentences told = repairs;
  bool senses_kept = true, large_opening = false;
  Result<Solid> solid = [&]() -> Result<Solid> {
    if (Status s = straighten(straight, diagonal, senses_kept, told); !s.ok()) return s.error();
    if (context.cancelled()) return cancelled_error();
    return close(std::move(straight), options, diagonal, senses_kept, large_opening, told);
  }();
  if (solid.ok()) {
    repairs = std::move(told);
  } else {
    if (large_opening || options.max_wrap_volume_change_relative <= 0 ||
        solid.error().kind != ErrorKind::kInvalidInput) {
      return solid.error();
    }
    auto wrapped =
        wrap_as_last_resort(std::move(mesh), solid.error().message,
                            {options.max_hole_relative * diagonal, options.max_wrap_volume_change_relative});
    if (!wrapped.ok()) return wrapped.error();
    repairs.push_back(wrapped->told);
    solid = close_again(std::move(wrapped.value().mesh), diagonal, repairs);
    if (!solid.ok()) return solid.error();
  }
  if (context.cancelled()) return cancelled_error();
  return unite(std::move(solid).value(), options, diagonal, std::move(repairs), std::move(warnings), context);
}

}  // namespace

Status RepairOptions::validate() const {
  const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!within(weld_tolerance_relative, 0, 1e-2))
    return invalid_input("weld_tolerance_relative must be in [0, 0.01]");
  if (!within(max_weld_tolerance_relative, weld_tolerance_relative, 1e-2)) {
    return invalid_input("max_weld_tolerance_relative must be in [weld_tolerance_relative, 0.01]");
  }
  if (!within(max_hole_relative, 0, 1)) return invalid_input("max_hole_relative must be in [0, 1]");
  if (!within(max_flat_cut_relative, 0, 1)) return invalid_input("max_flat_cut_relative must be in [0, 1]");
  if (!within(max_debris_relative, 0, 0.1)) return invalid_input("max_debris_relative must be in [0, 0.1]");
  if (!within(max_self_overlap_relative, 0, 1))
    return invalid_input("max_self_overlap_relative must be in [0, 1]");
  if (!within(max_wrap_volume_change_relative, 0, 1))
    return invalid_input("max_wrap_volume_change_relative must be in [0, 1]");
  return ok_status();
}

Result<RepairOutcome> repair(TriangleMesh mesh, const RepairOptions& options, RunContext& context) {
  if (Status s = options.validate(); !s.ok()) return s.error();
  if (Status s = check_input(mesh); !s.ok()) return s.error();
  try {
    return run_chain(std::move(mesh), options, context);
  } catch (const std::bad_alloc&) {
    throw;  // the job ends OUT_OF_MEMORY, not INTERNAL
  } catch (const std::exception& e) {
    return internal_error(fmt::format("the mesh could not be repaired: {}", e.what()));
  }
}

}  // namespace skinframe
