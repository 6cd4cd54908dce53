// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/solve_frame.h"

#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "worker/problem/problem_file.h"
#include "worker/problem/result_file.h"
#include "worker/problem/result_summary.h"
#include "worker/run/stop_signals.h"

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
  std::string text = fmt::format("{}: {}\n", to_string(r.reason), r.detail);
  text += fmt::format("{:<10}{:>14}{:>9}{:>9}\n", "stage", "volume mm3", "nodes", "struts");
  const std::pair<const char*, const StageRecord*> stages[] = {
      {"initial", &r.initial}, {"size", &r.size}, {"topology", &r.topology}, {"geometry", &r.geometry}};
  for (const auto& [name, stage] : stages)
    text += fmt::format("{:<10}{:>14.6g}{:>9}{:>9}\n", name, stage->volume_mm3, stage->nodes, stage->struts);
  if (r.lower_bound_mm3 && r.gap)
    text += fmt::format("lower bound {:.6g} mm3 for radii within their bounds: size is {:.3g} % above\n",
                        *r.lower_bound_mm3, 100 * *r.gap);
  if (r.relaxed_lower_bound_mm3 && r.relaxed_gap)
    text += fmt::format("lower bound {:.6g} mm3 with struts removed: topology is {:.3g} % above\n",
                        *r.relaxed_lower_bound_mm3, 100 * *r.relaxed_gap);
  if (r.best_reachable_displacement_mm)
    text += fmt::format("best displacement found {:.6g} mm\n", *r.best_reachable_displacement_mm);
  text += fmt::format("displacement {:.6g} mm, axial ratio {:.4g}, shear ratio {:.4g} ({} model)\n",
                      r.evaluation.max_displacement_mm, r.evaluation.max_axial_ratio,
                      r.evaluation.max_shear_ratio, to_string(r.problem.element));
  return text;
}

// What could be seen only at the end, after all the work: that there is no place for the result.
Status can_be_written(const std::filesystem::path& out) {
  const auto folder = out.has_parent_path() ? out.parent_path() : std::filesystem::path(".");
  std::error_code failure;
  if (std::filesystem::is_directory(folder, failure)) return ok_status();
  return io_error(
      fmt::format("{}: there is no such folder to write {} in", folder.string(), out.filename().string()));
}

int solve(const std::filesystem::path& problem, const std::filesystem::path& out,
          const SolveFrameOptions& options, RunContext& context) {
  if (const Status place = can_be_written(out); !place) {
    std::cerr << "skinframe: " << place.error().message << '\n';
    return kInternal;
  }
  const auto file = read_problem(problem, problem.string());
  if (!file) return fail(file.error());
  OptimizeOptions chosen = file->options;
  if (options.verbose) chosen.log = [](const std::string& line) { std::cerr << line << '\n'; };
  const auto result = optimize_frame(file->problem, chosen, context);
  if (!result) return fail(result.error());
  const nlohmann::json document = result_json(*result, file->problem);
  if (const Status written = write_result(document, out); !written) {
    std::cerr << "skinframe: " << written.error().message << '\n';
    return kInternal;
  }
  std::cout << (options.json_summary ? result_summary(document).dump() + "\n" : summary_text(*result));
  return result->reason == Termination::kInfeasible ? kInfeasible : kSolved;
}

// A line when the stage changes and twice a second.
class ProgressLines {
 public:
  void show(const Progress& tick) {
    using namespace std::chrono_literals;
    const auto now = std::chrono::steady_clock::now();
    if (stage_ == tick.stage && now - last_ < 500ms) return;
    stage_ = tick.stage;
    last_ = now;
    std::string line = fmt::format("{}  iteration {}", to_string(tick.stage), tick.iteration);
    if (tick.frame_volume_mm3) line += fmt::format("  frame {:.6g} mm3", *tick.frame_volume_mm3);
    if (tick.struts_left) line += fmt::format("  {} struts", *tick.struts_left);
    if (tick.violation) line += fmt::format("  violation {:.1e}", *tick.violation);
    std::cerr << line + "\n";
  }

 private:
  std::optional<Stage> stage_;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace

int solve_frame_main(const std::filesystem::path& problem, const std::filesystem::path& out,
                     const SolveFrameOptions& options, RunContext& context) {
  try {
    return solve(problem, out, options, context);
  } catch (const std::bad_alloc&) {
    std::cerr << "skinframe: " << problem.string()
              << ": needs more memory than there is; use a smaller frame\n";
    return kInternal;
  }
}

int solve_frame_main(const std::filesystem::path& problem, const std::filesystem::path& out,
                     const SolveFrameOptions& options) {
  const StopOnSignal stop;
  ProgressLines lines;
  RunContext context;
  context.stop = stop.token();
  if (!options.verbose) context.report = [&](const Progress& tick) { lines.show(tick); };
  return solve_frame_main(problem, out, options, context);
}

}  // namespace skinframe
