// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/prepare_solid.h"

#include <fmt/format.h>

#include <cmath>

#include "worker/mesh/read_mesh.h"
#include "worker/solid/place.h"
#include "worker/solid/repair.h"

namespace skinframe {
namespace {

// Bodies outside these bounds are mistakes of unit: nothing in a tray is larger, nothing smaller has an
// inside.
constexpr double kMinEdgeMm = 1.0, kMaxEdgeMm = 2000.0;
constexpr double kPlateToleranceMm = 1e-3;  // absolute: rounding to float of a body of that size

}  // namespace

Result<PreparedSolid> prepare_solid(const JobRequest& request, RunContext& context) {
  context.report({.stage = Stage::kRead});
  auto file = read_mesh(request.mesh_path, ReadLimits{}, context);
  if (!file) return file.error();

  context.report({.stage = Stage::kRepair});
  TriangleMesh mesh = std::move(file.value().mesh);
  if (request.options.size_mm) mesh = scale_to_largest_edge(std::move(mesh), *request.options.size_mm);
  const double edge = bounding_box(mesh).extent().maxCoeff();
  if (!(edge >= kMinEdgeMm && edge <= kMaxEdgeMm))
    return invalid_input(
        fmt::format("the largest edge of the bounding box is {:g} mm, outside {:g} .. {:g} mm; state the "
                    "size wanted with --size",
                    edge, kMinEdgeMm, kMaxEdgeMm));
  // Placed first: a solid's coordinates are floats, and moving it afterwards would round them a second time.
  mesh = put_on_plate(turn_up(std::move(mesh), request.options.up));
  auto repaired = repair(std::move(mesh), RepairOptions{}, context);
  if (!repaired) return repaired.error();
  Solid solid = std::move(repaired.value().solid);
  if (std::abs(solid.box().min.z()) > kPlateToleranceMm) {  // repair dropped what stood on the plate
    auto again = Solid::make(put_on_plate(solid.mesh()));
    if (!again) return again.error();
    solid = std::move(again).value();
  }
  Contact contact = find_contact(solid);
  MeshFacts facts{request.mesh_name, file->format, std::move(repaired.value().repairs),
                  std::move(repaired.value().warnings)};
  facts.repairs.insert(facts.repairs.begin(), file->notes.begin(), file->notes.end());
  return PreparedSolid{std::move(solid), std::move(contact), std::move(facts)};
}

}  // namespace skinframe
