// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/support_print.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "worker/mesh/append.h"
#include "worker/mesh/write_stl.h"
#include "worker/skin/triangle_tree.h"
#include "worker/support/layers.h"
#include "worker/support/overhang.h"
#include "worker/support/support_mesh.h"

namespace skinframe {
namespace {

constexpr double kNeckLengthInSkins = 1.0;
constexpr double kRoofPitchMm = 1.0;  // of the columns in which overhanging skin is looked for
constexpr std::size_t kMostRoofPoints = 5000;
constexpr int kMostRoofRounds = 3;
constexpr int kMostIslandRounds = 3;

// Where the profile says nothing a neck is half as thick as the thinnest strut.
double neck_diameter_mm(const PrinterProfile& printer) {
  return printer.neck_diameter_mm.value_or(printer.min_radius_mm);
}

// Where a layer would start in the air all the same: FlatSkin counts a spot as held by what comes up near it,
// and a lobe's lowest tip may be there before that. A point half way into the skin above each such part.
std::vector<Eigen::Vector3d> tips_to_hold(const FrameProblem& problem, const std::vector<double>& radii_mm,
                                          const PrintedBody& body, const BoundingBox& box,
                                          const PrinterProfile& printer, const PlannedSupports& supports,
                                          double plate_reach_mm) {
  const double eta = printer.min_radius_mm;
  const double least_mm2 =
      std::numbers::pi * eta * eta;  // a smaller spot is no wider than the thinnest strut
  std::vector<Eigen::Vector3d> points;
  for (const Island& island :
       find_islands(body, box, problem.frame, radii_mm, supports.plan, *printer.printable_length, {eta, eta})
           .islands) {
    if (island.area_mm2 < least_mm2 || island.at_mm.z() <= body.plate_z_mm + plate_reach_mm) continue;
    const Eigen::Vector3d within = island.at_mm + Eigen::Vector3d(0, 0, 0.5 * body.skin_thickness_mm);
    const double depth = body.depth_mm(within);
    points.push_back(depth > 0 && depth <= body.skin_thickness_mm ? within : island.at_mm);
  }
  return points;
}

}  // namespace

double plate_reach_mm(const Skin& skin) { return skin.thickness_mm + kContactToleranceMm; }

Result<std::optional<PlannedSupports>> plan_print(const FrameProblem& problem,
                                                  const std::vector<double>& radii_mm,
                                                  const TriangleMesh& mesh, const Skin& skin,
                                                  const PrinterProfile& printer, const RunContext& context) {
  if (printer.process != PrintProcess::kExtrusion || !printer.printable_length)
    return std::optional<PlannedSupports>();
  SupportOptions options;
  options.min_radius_mm = printer.min_radius_mm;
  options.slenderness = problem.material.slenderness;
  options.plate_reach_mm = plate_reach_mm(skin);
  const TriangleTree surface(mesh);
  const PrintedBody body = body_of(skin, surface);
  const PrintableLength& curve = *printer.printable_length;
  const FlatSkin bare(body, skin.body_box_mm, curve, kRoofPitchMm);
  PlannedSupports supports;
  // What holds the frame holds some of the skin, and what is added for the skin may change where it stands.
  for (int round = 0, island_rounds = 0;; ++round) {
    auto plan = plan_supports(problem.frame, curve, body, options, context);
    if (!plan) return plan.error();
    supports.plan = std::move(plan).value();
    FlatSkin held = bare;
    held.hold(holders_of(problem.frame, radii_mm, supports.plan, curve));
    supports.overhang = held.measure();
    const auto drop_known =
        [&](std::vector<Eigen::Vector3d>& points) {  // asked for already, and no use there
          std::erase_if(points, [&](const Eigen::Vector3d& point) {
            return std::find(options.roof_points.begin(), options.roof_points.end(), point) !=
                   options.roof_points.end();
          });
        };
    std::vector<Eigen::Vector3d> more;
    if (round < kMostRoofRounds) more = held.points_to_hold(kMostRoofPoints - options.roof_points.size());
    drop_known(more);
    if (more.empty()) {
      if (context.cancelled()) return cancelled_error();
      if (island_rounds++ == kMostIslandRounds) break;
      more =
          tips_to_hold(problem, radii_mm, body, skin.body_box_mm, printer, supports, options.plate_reach_mm);
      drop_known(more);
    }
    if (more.empty()) break;
    options.roof_points.insert(options.roof_points.end(), more.begin(), more.end());
  }
  supports.cavity_surface_mm2 = surface_area(skin.inner_surface);
  supports.state = size_supports(problem, radii_mm, printer.min_radius_mm, supports.plan);
  return std::optional<PlannedSupports>(std::move(supports));
}

MergedFrame with_internal_supports(const Frame& frame, const std::vector<double>& radii_mm,
                                   const SupportPlan* plan) {
  MergedFrame merged{frame, radii_mm};
  if (plan == nullptr) return merged;
  for (const SupportNode& node : plan->nodes) merged.frame.nodes_mm.push_back(node.at_mm);
  for (const SupportStrut& strut : plan->struts) {
    if (strut.kind != SupportKind::kInternal) continue;
    merged.frame.struts.push_back({strut.upper, strut.lower, false});
    merged.radii_mm.push_back(strut.radius_mm);
  }
  return merged;
}

nlohmann::json supports_json(const PlannedSupports& supports, const PrinterProfile& printer,
                             const Skin& skin) {
  using nlohmann::json;
  json points = json::array(), nodes = json::array(), struts = json::array();
  for (const PrintableLength::Point& point : printer.printable_length->points())
    points.push_back({{"angle_deg", point.angle_deg},
                      {"length_mm", point.length_mm ? json(*point.length_mm) : json(nullptr)}});
  for (const SupportNode& node : supports.plan.nodes)
    nodes.push_back({{"at_mm", {node.at_mm.x(), node.at_mm.y(), node.at_mm.z()}},
                     {"on", to_string(node.on)},
                     {"strut", node.strut}});
  for (const SupportStrut& strut : supports.plan.struts)
    struts.push_back({{"a", strut.upper},
                      {"b", strut.lower},
                      {"radius_mm", strut.radius_mm},
                      {"support", to_string(strut.kind)}});
  return {{"printable_length", points},
          {"self_supporting_angle_deg",
           self_supporting_angle(*printer.printable_length) * 180 / std::numbers::pi},
          {"plate_z_mm", skin.plate_z_mm},
          {"plate_reach_mm", plate_reach_mm(skin)},
          {"neck_diameter_mm", neck_diameter_mm(printer)},
          {"skin_tie_radius_mm", printer.min_radius_mm},
          {"nodes", nodes},
          {"struts", struts}};
}

Status write_supports(const Frame& frame, const Skin& skin, const PrinterRequest& printer,
                      const std::filesystem::path& folder, PrinterReport* report) {
  PlannedSupports& supports = *report->supports;
  const PrintedBody body = body_of(skin);
  const Neck neck{0.5 * neck_diameter_mm(printer.printer), kNeckLengthInSkins * skin.thickness_mm};
  SupportFacts& facts = supports.facts;
  facts = {};
  for (const SupportStrut& strut : supports.plan.struts) {
    (strut.kind == SupportKind::kInternal ? facts.internal : facts.external) += 1;
    facts.length_mm +=
        (node_mm(frame, supports.plan, strut.upper) - node_mm(frame, supports.plan, strut.lower)).norm();
  }
  TriangleMesh all;
  for (const SupportKind kind : {SupportKind::kInternal, SupportKind::kExternal}) {
    const TriangleMesh mesh = support_mesh(frame, supports.plan, kind, body, neck);
    if (mesh.triangles.empty()) continue;
    const std::string name = fmt::format("support-struts-{}.stl", to_string(kind));
    if (auto written = write_stl(mesh, folder / name); !written) return written;
    report->files.push_back(name);
    (kind == SupportKind::kInternal ? facts.internal_volume_mm3 : facts.external_volume_mm3) =
        signed_volume(mesh);
    append(all, mesh);
  }
  facts.weight_g =
      (facts.internal_volume_mm3 + facts.external_volume_mm3) * printer.material.density_g_cm3 * 1e-3;
  if (all.triangles.empty()) return ok_status();
  if (auto written = write_stl(all, folder / "support-struts.stl"); !written) return written;
  report->files.push_back("support-struts.stl");
  return ok_status();
}

}  // namespace skinframe
