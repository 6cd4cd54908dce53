// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/make_skin_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "worker/frame/convex_region.h"
#include "worker/mesh/write_stl.h"
#include "worker/pipeline/pose_problem.h"
#include "worker/pipeline/write_json.h"
#include "worker/problem/problem_file.h"

namespace skinframe {
namespace {

// Seconds since the last lap, under the stage's name.
class Laps {
 public:
  explicit Laps(std::map<std::string, double>* seconds) : seconds_(seconds) {}
  void lap(const std::string& stage) {
    const auto now = std::chrono::steady_clock::now();
    (*seconds_)[stage] = std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::map<std::string, double>* seconds_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// Upright, and turned by 90 degrees about z if that helps.
Status fits_tray(const Solid& solid, const PrinterProfile& printer) {
  const Eigen::Vector3d size = solid.box().extent();
  Eigen::Vector3d tray = printer.tray_mm;
  if ((size.x() > size.y()) != (tray.x() > tray.y())) std::swap(tray.x(), tray.y());
  const Eigen::Vector3d excess = (size - tray).cwiseMax(0.0);
  if (excess.maxCoeff() <= 0) return ok_status();
  return Error{ErrorKind::kDoesNotFit,
               fmt::format("{:.1f} x {:.1f} x {:.1f} mm does not fit the tray of {} ({:g} x {:g} x {:g} mm) by {:.1f} mm; use "
                           "a smaller --size",
                           size.x(), size.y(), size.z(), printer.id, printer.tray_mm.x(), printer.tray_mm.y(),
                           printer.tray_mm.z(), excess.maxCoeff())};
}

std::vector<std::string> honest_warnings(const PrinterProfile& printer) {
  switch (printer.process) {
    case PrintProcess::kExtrusion:
      return {"support struts are not generated yet: struts that overhang need the slicer's own supports"};
    case PrintProcess::kPowder:
    case PrintProcess::kResin:
      return {"drain holes are not cut yet: what fills the cavity while printing stays inside"};
  }
  return {};
}

PrinterReport begin_report(const PrinterRequest& request) {
  PrinterReport report;
  report.printer = request.printer.id;
  report.material = request.material.id;
  report.min_radius_mm = request.printer.min_radius_mm;
  report.skin_thickness_mm = request.printer.skin_thickness_mm();
  report.max_internal_radius_mm = request.printer.max_internal_radius_mm;
  report.density_g_cm3 = request.material.density_g_cm3;
  report.tray_mm = request.printer.tray_mm;
  report.price_per_kg = request.price_per_kg;
  report.warnings = honest_warnings(request.printer);
  return report;
}

OptimizeOptions optimize_options(const JobOptions& options, const Skin& skin) {
  OptimizeOptions out;
  out.order = options.order == StageOrder::kPaper ? OptimizeOptions::Order::kPaper : OptimizeOptions::Order::kTight;
  out.convex_regions = [&skin](const Frame& frame, const std::vector<double>& radii_mm) {
    return convex_regions(frame, radii_mm, skin);
  };
  out.accepts = [&skin](const Frame& frame, const std::vector<double>& radii_mm) {
    return struts_inside(frame, radii_mm, skin);
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
  const Frame& frame = result.problem.frame;
  result.initial = result.size = result.topology = result.geometry = {static_cast<int>(frame.nodes_mm.size()),
                                                                      static_cast<int>(frame.struts.size()),
                                                                      result.evaluation.frame_volume_mm3};
  return result;
}

std::string termination_name(Termination termination) {
  switch (termination) {
    case Termination::kOptimal: return "OPTIMAL";
    case Termination::kInfeasible: return "INFEASIBLE";
    case Termination::kIterationLimit: return "ITERATION_LIMIT";
  }
  return "INTERNAL";
}

void fill_statistics(const PreparedSolid& prepared, const Skin& skin, BalanceState balance, PrinterReport* report) {
  const OptimizeResult& result = *report->optimised;
  Statistics& s = report->statistics;
  s.solid_volume_mm3 = prepared.solid.volume_mm3();
  s.skin_volume_mm3 = skin.volume_mm3;
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
  switch (balance) {
    case BalanceState::kEnforced:
      s.balance = report->reason == Reason::kInfeasible || report->termination == "NOT_OPTIMIZED" ? "not_claimed" : "holds";
      break;
    case BalanceState::kNotStanding: s.balance = "not_standing"; break;
    case BalanceState::kOff: s.balance = "off"; break;
  }
}

}  // namespace

Result<PrinterReport> make_skin_frame(const PreparedSolid& prepared, const PrinterRequest& request, const JobRequest& job,
                                      const std::filesystem::path& out_dir, const PipelineObserver& observer,
                                      RunContext& context) {
  const PrinterProfile& printer = request.printer;
  if (auto fits = fits_tray(prepared.solid, printer); !fits) return fits.error();
  PrinterReport report = begin_report(request);
  std::optional<double> skin_volume_mm3;
  context.report = [&](const Progress& progress) {
    observer.progress({printer.id, progress, skin_volume_mm3, prepared.solid.volume_mm3()});
  };
  Laps laps(&report.seconds);

  context.report({.stage = Stage::kSkin});
  auto skin = build_skin(prepared.solid, SkinOptions{.thickness_mm = printer.skin_thickness_mm()}, context);
  if (!skin) return skin.error();
  skin_volume_mm3 = skin->volume_mm3;
  laps.lap("skin");

  context.report({.stage = Stage::kSample});
  FrameOptions frame_options;
  frame_options.skin_nodes = job.options.skin_nodes;
  frame_options.internal_nodes = job.options.internal_nodes;
  frame_options.plate.tensile_modulus_mpa = request.material.tensile_modulus_mpa;
  frame_options.plate.displacement_limit_mm = job.options.displacement_limit_mm;
  frame_options.strut_radius_mm = printer.min_radius_mm;
  auto sampled = sample_frame(*skin, frame_options, context);
  if (!sampled) return sampled.error();
  report.warnings.insert(report.warnings.end(), sampled->warnings.begin(), sampled->warnings.end());
  laps.lap("sample");

  const BalanceState balance = decide_balance(job.options.balance, prepared.contact);
  if (balance == BalanceState::kEnforced && prepared.contact.hull.size() < 3) {
    report.reason = Reason::kInfeasible;
    report.detail = "balance cannot hold: the base contact has no area; see --up and --balance";
    return report;
  }
  auto problem = pose_problem(prepared.solid, prepared.contact, *skin, *sampled, request, job.loads, job.options);
  if (!problem) return problem.error();
  if (balance == BalanceState::kNotStanding)
    report.warnings.push_back(fmt::format(
        "the solid does not stand on its lowest plane: its centre of gravity is {:.1f} mm outside the base contact, so "
        "balance is not enforced (see --up and --balance)",
        -prepared.contact.margin_mm));
  if (job.options.no_optimize) {
    report.optimised = at_lower_bounds(std::move(problem).value());
    report.termination = "NOT_OPTIMIZED";
    report.termination_detail = "radii stand at their lower bounds as asked; no limit is claimed";
  } else {
    auto optimised = optimize_frame(*problem, optimize_options(job.options, *skin), context);
    if (!optimised) return optimised.error();
    report.optimised = std::move(optimised).value();
    report.termination = termination_name(report.optimised->reason);
    report.termination_detail = report.optimised->detail;
  }
  const OptimizeResult& result = *report.optimised;
  report.seconds.insert(result.seconds.begin(), result.seconds.end());
  laps.lap("optimize");
  if (report.termination == "INFEASIBLE") {
    report.reason = Reason::kInfeasible;
    report.detail = result.detail;
  }
  fill_statistics(prepared, *skin, balance, &report);

  context.report({.stage = Stage::kExport, .frame_volume_mm3 = result.evaluation.frame_volume_mm3});
  const auto folder = out_dir / printer.id;
  auto frame_json = to_json(result.problem, result.radii_mm, result.displacements_mm);
  if (auto written = write_json(folder / "frame.json", frame_json); !written) return written.error();
  if (report.reason != Reason::kNone) return report;

  auto merged = merge_solid(prepared.solid, *skin, result.problem.frame, result.radii_mm,
                            ExportOptions{.voxel_mm = job.options.voxel_mm}, context);
  if (!merged) return merged.error();
  if (auto written = write_stl(merged->mesh, folder / "skin-frame.stl"); !written) return written.error();
  report.voxel_mm = merged->voxel_mm;
  report.statistics.printed_volume_mm3 = merged->volume_mm3;
  report.statistics.printed_ratio = merged->volume_mm3 / prepared.solid.volume_mm3();
  report.statistics.weight_g = merged->volume_mm3 * request.material.density_g_cm3 * 1e-3;
  laps.lap("export");
  return report;
}

}  // namespace skinframe
