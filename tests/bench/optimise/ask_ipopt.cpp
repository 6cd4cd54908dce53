// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/optimise/ask_ipopt.h"

#include <fmt/format.h>

#include "tests/bench/optimise/child.h"
#include "worker/mechanics/evaluation.h"

namespace skinframe::bench {

std::optional<std::filesystem::path> find_oracle() {
  std::error_code error;
  const auto path = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "skinframe_oracle";
  if (error || !std::filesystem::exists(path, error)) return std::nullopt;
  return path;
}

Row ask_ipopt(const std::filesystem::path& oracle, const std::filesystem::path& problem_file,
              const FrameProblem& problem, double tolerance, double max_seconds) {
  Row row;
  const ChildEnd end =
      run_child({oracle.string(), problem_file.string(), "--tolerance", fmt::format("{:g}", tolerance),
                 "--max-seconds", fmt::format("{:g}", max_seconds)},
                1.5 * max_seconds + 10);
  if (end.timed_out || end.exit_code != 0) {
    row.status = end.timed_out ? "time limit" : fmt::format("exit code {}", end.exit_code);
    return row;
  }
  const auto answer = nlohmann::json::parse(end.out);
  row.status = answer.at("status");
  const auto both = [&](const char* clock) {
    return answer.at(clock).at("start").get<double>() + answer.at(clock).at("solve").get<double>();
  };
  row.seconds = both("seconds");
  row.cpu_seconds = both("cpu_seconds");
  row.solve_seconds = answer.at("seconds").at("solve");
  row.peak_mb = answer.at("peak_mb");
  row.factorisations = answer.at("factorisations");
  row.struts_left = static_cast<int>(problem.frame.struts.size());
  if (answer.contains("iterations")) row.iterations = answer["iterations"];
  if (answer.contains("kkt_error")) row.kkt_error = answer["kkt_error"];
  const std::vector<double> areas = answer.at("areas_mm2");
  if (areas.size() != problem.frame.struts.size()) return row;
  const Evaluation evaluation = evaluate(problem, radii_of(areas));
  row.volume_mm3 = evaluation.frame_volume_mm3;
  row.worst_ratio = utilisation(evaluation);
  return row;
}

}  // namespace skinframe::bench
