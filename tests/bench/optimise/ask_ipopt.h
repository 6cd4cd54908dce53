// SPDX-License-Identifier: GPL-3.0-or-later
// Ipopt's row, by the oracle's program.
#pragma once

#include <filesystem>
#include <optional>

#include "tests/bench/optimise/row.h"
#include "worker/mechanics/frame_problem.h"

namespace skinframe::bench {

std::optional<std::filesystem::path> find_oracle();  // beside this program

// Ipopt's tolerance is `tolerance`, as SizeOpt's is. `seconds` are those of its start (the smallest
// uniform radius, as ours) and of its solve; `solve_seconds` those of its solve alone.
Row ask_ipopt(const std::filesystem::path& oracle, const std::filesystem::path& problem_file,
              const FrameProblem& problem, double tolerance, double max_seconds);

}  // namespace skinframe::bench
