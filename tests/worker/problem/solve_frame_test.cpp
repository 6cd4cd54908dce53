// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/solve_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/worker/problem/sample_problem.h"
#include "worker/mechanics/evaluation.h"
#include "worker/problem/problem_file.h"

namespace skinframe {
namespace {

using nlohmann::json;
using testing::sample_problem;

class SolveFrame : public ::testing::Test {
 protected:
  std::filesystem::path problem_ = ::testing::TempDir() + "solve_frame_problem.json";
  std::filesystem::path out_ = ::testing::TempDir() + "solve_frame_result.json";

  void SetUp() override { std::filesystem::remove(out_); }
  int solve(const json& document) {
    std::ofstream(problem_) << document.dump();
    RunContext context;
    return solve_frame_main(problem_, out_, {.json_summary = true}, context);
  }
  json result() const { return json::parse(std::ifstream(out_)); }
};

TEST_F(SolveFrame, ResultIsAProblemFileThatHoldsItsOwnClaims) {
  ASSERT_EQ(solve(sample_problem()), 0);
  const json document = result();
  EXPECT_EQ(document["termination"]["reason"], "optimal");
  const auto again = parse_problem(document);
  ASSERT_TRUE(again.ok()) << again.error().message;
  std::vector<double> radii;
  for (const json& strut : document["struts"]) radii.push_back(strut["radius_mm"]);
  const Evaluation evaluation = evaluate(again->problem, radii);
  EXPECT_EQ(violated_constraint(evaluation, 1e-5), "");
  EXPECT_NEAR(evaluation.frame_volume_mm3, document["volumes_mm3"]["geometry"].get<double>(), 1e-6);
  EXPECT_EQ(document["load_cases"][0]["axial_force_n"].size(), radii.size());
}

TEST_F(SolveFrame, OptimisingTheResultAgainChangesNothing) {
  ASSERT_EQ(solve(sample_problem()), 0);
  const json first = result();
  ASSERT_EQ(solve(first), 0);
  const double before = first["volumes_mm3"]["geometry"], after = result()["volumes_mm3"]["geometry"];
  EXPECT_NEAR(after, before, 1e-5 * before);
}

TEST_F(SolveFrame, InfeasibleIsExitCode4AndStillWritten) {
  json document = sample_problem();
  document["load_cases"][0]["forces"][0]["force_n"] = {0, 0, -1e5};
  EXPECT_EQ(solve(document), 4);
  EXPECT_EQ(result()["termination"]["reason"], "infeasible");
  EXPECT_EQ(result()["termination"]["violated_constraint"], "displacement");
  EXPECT_GT(result()["termination"]["best_reachable_displacement_mm"].get<double>(), 0.05);
}

TEST_F(SolveFrame, BadInputIsExitCode3AndWritesNothing) {
  json document = sample_problem();
  document["struts"][0]["a"] = 77;
  EXPECT_EQ(solve(document), 3);
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(SolveFrame, CancelledIsExitCode6) {
  std::ofstream(problem_) << sample_problem().dump();
  std::stop_source source;
  source.request_stop();
  RunContext context;
  context.stop = source.get_token();
  EXPECT_EQ(solve_frame_main(problem_, out_, {.json_summary = true}, context), 6);
}

TEST_F(SolveFrame, VerboseTellsEveryIterationOfTheInteriorPoint) {
  std::ofstream(problem_) << sample_problem().dump();
  RunContext context;
  ::testing::internal::CaptureStderr();
  ASSERT_EQ(solve_frame_main(problem_, out_, {.json_summary = true, .verbose = true}, context), 0);
  const std::string told = ::testing::internal::GetCapturedStderr();
  const auto lines = std::count(told.begin(), told.end(), '\n');
  EXPECT_GT(lines, result()["iterations"]["interior_point"].get<int>())
      << told;  // a heading before each program
  EXPECT_GE(result()["iterations"]["factorisations"], result()["iterations"]["interior_point"]);
}

}  // namespace
}  // namespace skinframe
