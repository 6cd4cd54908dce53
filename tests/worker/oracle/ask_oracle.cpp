// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/worker/oracle/ask_oracle.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/integration/process.h"
#include "worker/problem/problem_file.h"

namespace skinframe::testing {

OracleAnswer ask_oracle(const FrameProblem& problem, bool every_strain) {
  const integration::Scratch scratch;
  const auto file = scratch / "problem.json";
  std::ofstream(file) << to_json(problem, {}, {});
  std::vector<std::string> command{integration::binary("skinframe_oracle"), file, "--max-seconds", "60"};
  if (every_strain) command.push_back("--every-strain");
  const integration::Ran ran = integration::run(command, scratch.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  if (ran.exit_code != 0) return {};
  const auto answer = nlohmann::json::parse(ran.out);
  return {answer["status"], answer["volume_mm3"], answer["areas_mm2"], answer["iterations"],
          answer["factorisations"]};
}

}  // namespace skinframe::testing
