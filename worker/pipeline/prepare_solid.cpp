// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/prepare_solid.h"

#include <fmt/format.h>

#include <cmath>

#include "worker/mesh/read_mesh.h"
#include "worker/pipeline/orient_solid.h"
#include "worker/solid/place.h"
#include "worker/solid/repair.h"

namespace skinframe {
namespace {

// Bodies outside these bounds are mistakes of unit: nothing in a tray is larger, nothing smaller has an
// inside.
constexpr double kMinEdgeMm = 1.0, kMaxEdgeMm = 2000.0;
constexpr double kSizeToleranceRelative = 1e-5;  // of --size: likewise
constexpr double kPlateToleranceMm = 1e-3;       // absolute: rounding to float of a body of that size

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
  std::vector<std::string>& repairs = repaired.value().repairs;
  const double repaired_edge = solid.box().extent().maxCoeff();
  const double wanted_edge = request.options.size_mm.value_or(repaired_edge);
  const bool resized = std::abs(repaired_edge - wanted_edge) > kSizeToleranceRelative * wanted_edge;
  if (resized || std::abs(solid.box().min.z()) > kPlateToleranceMm) {  // repair dropped what bounded the box
    auto again = Solid::make(put_on_plate(scale_to_largest_edge(solid.mesh(), wanted_edge)));
    if (!again) return again.error();
    solid = std::move(again).value();
    if (resized) {
      repairs.push_back(fmt::format("scaled what is left by {:.6g}, from {:.4g} mm to the size wanted",
                                    wanted_edge / repaired_edge, repaired_edge));
    }
  }
  std::optional<OrientationFacts> orientation;
  if (request.options.orient == Orient::kBest) {
    auto oriented = orient_solid(solid, request);
    if (!oriented) return oriented.error();
    solid = std::move(oriented.value().solid);
    orientation = std::move(oriented.value().facts);
  }
  Contact contact = find_contact(solid);
  MeshFacts facts{request.mesh_name, file->format, std::move(repairs), std::move(repaired.value().warnings),
                  std::move(orientation)};
  facts.repairs.insert(facts.repairs.begin(), file->notes.begin(), file->notes.end());
  return PreparedSolid{std::move(solid), std::move(contact), std::move(facts)};
}

}  // namespace skinframe
