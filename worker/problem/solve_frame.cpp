// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/solve_frame.h"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "worker/problem/problem_file.h"
#include "worker/problem/result_file.h"

namespace skinframe {
namespace {

constexpr int kSolved = 0, kBadInput = 3, kInfeasible = 4, kInternal = 5, kCancelled = 6;

int fail(const Error& error) {
  std::cerr << "skinframe: " << error.message << '\n';
  switch (error.kind) {
    case ErrorKind::kCancelled:
      return kCancelled;
    case ErrorKind::kInternal:
      return kInternal;
    default:
      return kBadInput;
  }
}

std::string summary_text(const OptimizeResult& r) {
  return fmt::format(
      "{}: {}\n"
      "volume {:.1f} mm3 (size {:.1f}, topology {:.1f}, geometry {:.1f}), {} nodes, {} struts\n"
      "displacement {:.6g} mm, axial ratio {:.4g}, shear ratio {:.4g}\n",
      to_string(r.reason), r.detail, r.evaluation.frame_volume_mm3, r.size.volume_mm3, r.topology.volume_mm3,
      r.geometry.volume_mm3, r.geometry.nodes, r.geometry.struts, r.evaluation.max_displacement_mm,
      r.evaluation.max_axial_ratio, r.evaluation.max_shear_ratio);
}

std::string summary_json(const OptimizeResult& r) {
  const nlohmann::json summary{{"reason", to_string(r.reason)},
                               {"detail", r.detail},
                               {"frame_volume_mm3", r.evaluation.frame_volume_mm3},
                               {"max_displacement_mm", r.evaluation.max_displacement_mm},
                               {"nodes", r.geometry.nodes},
                               {"struts", r.geometry.struts}};
  return summary.dump() + "\n";
}

}  // namespace

int solve_frame_main(const std::filesystem::path& problem, const std::filesystem::path& out,
                     bool json_summary, RunContext& context) {
  auto file = read_problem(problem);
  if (!file) return fail(file.error());
  auto result = optimize_frame(file->problem, file->options, context);
  if (!result) return fail(result.error());
  if (const Status written = write_result(*result, out); !written) {
    std::cerr << "skinframe: " << written.error().message << '\n';
    return kInternal;
  }
  std::cout << (json_summary ? summary_json(*result) : summary_text(*result));
  return result->reason == Termination::kInfeasible ? kInfeasible : kSolved;
}

int solve_frame_main(const std::filesystem::path& problem, const std::filesystem::path& out,
                     bool json_summary) {
  RunContext context;
  context.report = [](const Progress& tick) {
    if (tick.iteration % 10 == 0 && tick.frame_volume_mm3)
      std::cerr << fmt::format("{} {}: {:.1f} mm3\n", to_string(tick.stage), tick.iteration,
                               *tick.frame_volume_mm3);
  };
  return solve_frame_main(problem, out, json_summary, context);
}

}  // namespace skinframe
