// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/solve_and_merge.h"

#include <fmt/format.h>

#include "worker/frame/convex_region.h"
#include "worker/mechanics/equilibrium.h"
#include "worker/pipeline/support_print.h"

namespace skinframe {
namespace {

// The constraint's name in the report when only the print, not the model, fails to stand.
constexpr const char* kPrintedBalance = "balance of the printed mesh";
constexpr double kRadiusTolerance = 0.01;  // relative, of a strut beside a drain hole

bool openings_are_free(const Frame& frame, const std::vector<double>& radii_mm,
                       const std::vector<Opening>& openings) {
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    const Strut& strut = frame.struts[j];
    if (!strut.is_skin && room_mm(openings, frame.nodes_mm[strut.a], frame.nodes_mm[strut.b]) <
                              radii_mm[j] * (1.0 - kRadiusTolerance))
      return false;
  }
  return true;
}

OptimizeOptions optimize_options(const JobOptions& options, const Skin& skin,
                                 const std::vector<Opening>& openings) {
  OptimizeOptions out;
  out.order =
      options.order == StageOrder::kPaper ? OptimizeOptions::Order::kPaper : OptimizeOptions::Order::kTight;
  out.convex_regions = [&skin](const Frame& frame, const std::vector<double>& radii_mm) {
    return convex_regions(frame, radii_mm, skin);
  };
  out.accepts = [&skin, &openings](const Frame& frame, const std::vector<double>& radii_mm) {
    return struts_inside(frame, radii_mm, skin) && openings_are_free(frame, radii_mm, openings);
  };
  return out;
}

// --no-optimize: every radius at its lower bound, nothing removed, no limit claimed.
OptimizeResult at_lower_bounds(FrameProblem problem) {
  OptimizeResult result;
  std::vector<double> areas;
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j)
    areas.push_back(area_bounds(problem, static_cast<int>(j)).lower_mm2);
  result.radii_mm = radii_of(areas);
  result.problem = std::move(problem);
  const auto responses = solve_equilibrium(result.problem, areas);
  for (const CaseResponse& response : responses) result.displacements_mm.push_back(response.displacements_mm);
  result.evaluation = evaluate(result.problem, result.radii_mm, responses);
  result.initial = result.size = result.topology = result.geometry =
      record_of(result.problem.frame, result.radii_mm, result.evaluation.frame_volume_mm3);
  return result;
}

std::string termination_name(Termination termination) {
  switch (termination) {
    case Termination::kOptimal:
      return "OPTIMAL";
    case Termination::kInfeasible:
      return "INFEASIBLE";
    case Termination::kIterationLimit:
      return "ITERATION_LIMIT";
  }
  return "INTERNAL";
}

void fill_statistics(const SolveSetting& setting, PrinterReport* report) {
  const PreparedSolid& prepared = setting.prepared;
  const OptimizeResult& result = *report->optimised;
  Statistics& s = report->statistics;
  s.solid_volume_mm3 = prepared.solid.volume_mm3();
  s.skin_volume_mm3 = setting.skin.volume_mm3;
  s.frame_volume_mm3 = result.evaluation.frame_volume_mm3;
  s.total_volume_mm3 = s.skin_volume_mm3 + s.frame_volume_mm3;
  s.ratio = s.total_volume_mm3 / s.solid_volume_mm3;
  s.skin_nodes = result.problem.frame.skin_node_count;
  s.nodes = static_cast<int>(result.problem.frame.nodes_mm.size());
  s.struts = static_cast<int>(result.problem.frame.struts.size());
  s.max_displacement_mm = result.evaluation.max_displacement_mm;
  if (prepared.contact.hull.size() >= 3)
    s.balance_margin_mm =
        signed_margin_mm(prepared.contact.hull, result.evaluation.centre_of_gravity_mm.head<2>());
  switch (setting.balance) {
    case BalanceState::kEnforced:
      s.balance = report->reason == Reason::kInfeasible || report->termination == "NOT_OPTIMIZED"
                      ? "not_claimed"
                      : "holds";
      break;
    case BalanceState::kNotStanding:
      s.balance = "not_standing";
      break;
    case BalanceState::kOff:
      s.balance = "off";
      break;
  }
}

// Fills the report's optimiser part: the optimised frame, or the one at its lower bounds.
Status solve_frame(const FrameProblem& problem, const SolveSetting& setting, PrinterReport* report,
                   RunContext& context) {
  const JobOptions& options = setting.options;
  if (options.no_optimize) {
    report->optimised = at_lower_bounds(problem);
    report->termination = "NOT_OPTIMIZED";
    report->termination_detail = "radii stand at their lower bounds as asked; no limit is claimed";
    return ok_status();
  }
  context.report({.stage = Stage::kSize, .struts_left = static_cast<int>(problem.frame.struts.size())});
  if (context.cancelled()) return cancelled_error();
  OptimizeOptions how = optimize_options(options, setting.skin, setting.openings);
  how.checkpoints = setting.checkpoints;
  auto optimised = [&] {
    if (!setting.start) return optimize_frame(problem, how, context);
    FrameProblem reduced = setting.start->problem;
    reduced.balance = problem.balance;  // drawn in from round to round
    return optimize_from(setting.start->earlier, reduced, problem, how, &*report->warm_start, context);
  }();
  if (!optimised) return optimised.error();
  report->optimised = std::move(optimised).value();
  report->termination = termination_name(report->optimised->reason);
  report->termination_detail = report->optimised->detail;
  if (report->optimised->reason == Termination::kInfeasible) {
    report->reason = Reason::kInfeasible;
    report->detail = report->optimised->detail + " (paper model)";
  }
  return ok_status();
}

}  // namespace

Result<std::optional<MergedPrint>> solve_and_merge(const SolveSetting& setting, FrameProblem* problem,
                                                   PrinterReport* report, RunContext& context) {
  for (int round = 0;; ++round) {
    auto solved = solve_frame(*problem, setting, report, context);
    if (!solved) return solved.error();
    setting.laps.lap("optimize");
    fill_statistics(setting, report);
    if (report->reason != Reason::kNone) return std::optional<MergedPrint>();

    auto supports = plan_print(report->optimised->problem, report->optimised->radii_mm,
                               setting.prepared.solid.mesh(), setting.skin, setting.printer, context);
    if (!supports) return supports.error();
    report->supports = std::move(supports).value();
    setting.laps.lap("support");

    context.report({.stage = Stage::kExport, .frame_volume_mm3 = report->statistics.frame_volume_mm3});
    const MergedFrame printed =
        with_internal_supports(report->optimised->problem.frame, report->optimised->radii_mm,
                               report->supports ? &report->supports->plan : nullptr);
    auto merged = merge_solid(setting.prepared.solid, setting.skin, printed.frame, printed.radii_mm,
                              ExportOptions{.voxel_mm = setting.options.voxel_mm}, context);
    if (!merged) return merged.error();
    setting.laps.lap("export");
    MergedPrint print{std::move(merged).value(), {}};
    if (!setting.openings.empty()) {
      print.opened =
          open_holes(print.closed.mesh, setting.prepared.solid.mesh().triangles.size(), setting.openings);
      setting.laps.lap("holes");
    }
    const double margin_mm =
        signed_margin_mm(setting.prepared.contact.hull, volume_centroid(print.mesh()).head<2>());
    if (setting.prepared.contact.hull.size() >= 3) report->statistics.printed_balance_margin_mm = margin_mm;
    if (report->statistics.balance != "holds" || margin_mm >= 0)
      return std::optional<MergedPrint>(std::move(print));
    if (round == kMaxBalanceRounds) {
      report->reason = Reason::kInfeasible;
      report->termination = "INFEASIBLE";
      report->optimised->violated_constraint = kPrintedBalance;
      report->detail = report->termination_detail = fmt::format(
          "balance: the centre of gravity of the printed mesh stays {:.2f} mm outside the base contact",
          -margin_mm);
      fill_statistics(setting, report);
      report->statistics.printed_balance_margin_mm.reset();  // nothing is exported
      return std::optional<MergedPrint>();
    }
    for (HalfPlane& plane : problem->balance) plane.offset_mm -= kBalanceReserveMm - margin_mm;
  }
}

}  // namespace skinframe
