// SPDX-License-Identifier: GPL-3.0-or-later
// The check of a frame job's result: yes to what the job wrote, and no to each lie told in a copy of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/worker/pipeline/small_job.h"
#include "tests/worker/problem/sample_problem.h"
#include "worker/check/check.h"
#include "worker/job/run_frame_job.h"

namespace skinframe::check {
namespace {

using nlohmann::json;
using Names = std::vector<std::string>;

// A tripod of the paper's struts that has to stand: the plate ends just left of where the load case leans.
json standing_tripod() {
  json problem = skinframe::testing::sample_problem();
  problem["mechanics"] = "paper";
  problem["material"]["shear_strength_mpa"] = 48;
  problem["load_cases"][0]["gravity"] = true;
  problem["balance_half_planes"] = json::parse(R"([{"normal": [1, 0], "offset_mm": 40}])");
  return problem;
}

class SolutionTest : public ::testing::Test {
 protected:
  void solve(const json& problem) {
    std::ofstream(folder_.path() / "problem.json") << problem;
    JobFile file;
    file.frame_problem = folder_.path() / "problem.json";
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> nowhere(std::tmpfile(), std::fclose);
    EventStream events(nowhere.get());
    run_frame_job(file, folder_.path(), events, nullptr, RunContext{});
  }
  // The claims that do not hold after `lie` changed the file; the file is as before afterwards.
  Names denied(const char* name, const std::function<void(json&)>& lie) {
    const json honest = read(name);
    json changed = honest;
    lie(changed);
    write(name, changed);
    Names names;
    for (const Claim& claim : claims())
      if (!claim.holds) names.push_back(claim.name);
    write(name, honest);
    return names;
  }
  std::vector<Claim> claims() {
    RunContext context;
    const auto verdicts = check_directory(folder_.path(), context);
    if (!verdicts.ok()) return {{"error: " + verdicts.error().message, false, ""}};
    return verdicts->front().claims;
  }
  Names report_denied(const std::function<void(json&)>& lie) {
    return denied("report.json", [&](json& report) { lie(report["frame"]); });
  }
  Names result_denied(const std::function<void(json&)>& lie) { return denied("result.json", lie); }
  json read(const char* name) const { return json::parse(std::ifstream(folder_.path() / name)); }
  void write(const char* name, const json& document) { std::ofstream(folder_.path() / name) << document; }

  test::TemporaryFolder folder_;
};

TEST_F(SolutionTest, AnHonestResultHoldsInEveryClaimAndEachLieIsDenied) {
  solve(standing_tripod());
  for (const Claim& claim : claims()) EXPECT_TRUE(claim.holds) << claim.name << ": " << claim.measured;
  EXPECT_GE(claims().size(), 7u);
  using ::testing::Contains;
  EXPECT_THAT(report_denied([](json& f) { f["evaluation"]["frame_volume_mm3"] = 1; }),
              Contains("volume and counts"));
  EXPECT_THAT(report_denied([](json& f) { f["counts"]["geometry"]["struts"] = 5; }),
              Contains("volume and counts"));
  EXPECT_THAT(report_denied([](json& f) { f["volumes_mm3"]["size"] = 1; }),
              Contains("no volume rises from stage to stage"));
  EXPECT_THAT(report_denied([](json& f) { f["lower_bound_mm3"] = 1e9; }),
              Contains("lower bound of the sized volume"));
  EXPECT_THAT(report_denied([](json& f) { f["gap"] = -0.2; }), Contains("lower bound of the sized volume"));
  EXPECT_THAT(report_denied([](json& f) { f["evaluation"]["max_displacement_mm"] = 0.01; }),
              Contains("displacement (paper model)"));
  EXPECT_THAT(report_denied([](json& f) { f["evaluation"]["max_axial_ratio"] = 0.9; }),
              Contains("stresses (paper model)"));
  EXPECT_THAT(report_denied([](json& f) { f["evaluation"]["balance_margin_mm"] = 99; }), Contains("balance"));
  EXPECT_THAT(result_denied([](json& r) { r["struts"][0]["radius_mm"] = 0.4; }), Contains("radii"));
  EXPECT_THAT(result_denied([](json& r) { r["struts"][2]["max_radius_mm"] = 0.501; }), Contains("radii"));
  EXPECT_THAT(result_denied([](json& r) { r["material"]["slenderness"] = 10; }), Contains("slenderness"));
  EXPECT_THAT(result_denied([](json& r) { r["displacement_limit_mm"] = 0.01; }),
              Contains("displacement (paper model)"));
  EXPECT_THAT(result_denied([](json& r) { r["load_cases"][0]["displacements_mm"][3][2] = 0.01; }),
              Contains("equilibrium (paper model)"));
  EXPECT_THAT(result_denied([](json& r) { r["material"]["tensile_strength_mpa"] = 0.01; }),
              Contains("stresses (paper model)"));
  EXPECT_THAT(result_denied([](json& r) { r["balance_half_planes"][0]["offset_mm"] = 10; }),
              Contains("balance"));
  EXPECT_THAT(result_denied([](json& r) { r["struts"] = json::array(); }), Contains("frame"));
  EXPECT_THAT(result_denied([](json& r) { r["struts"][0]["a"] = 44; }),
              Contains(::testing::HasSubstr("44 is not a node")));
}

TEST_F(SolutionTest, TheStrutsOfEachStageAreJudged) {
  solve(standing_tripod());
  using ::testing::Contains;
  const auto sizes = [](json& r, const char* stage, const char* which) -> json& {
    return r["strut_sizes"][stage][which];
  };
  EXPECT_THAT(result_denied([&](json& r) { sizes(r, "size", "radii_mm")[0] = 0.9; }),
              Contains("struts of each stage"));  // no longer the reported volume
  EXPECT_THAT(result_denied([&](json& r) { sizes(r, "topology", "lengths_mm").erase(0); }),
              Contains("struts of each stage"));
  EXPECT_THAT(report_denied([](json& f) { f["counts"]["initial"]["struts"] = 4; }),
              Contains("struts of each stage"));
  EXPECT_THAT(report_denied([](json& f) { f["volumes_mm3"]["initial"] = 1; }),
              Contains("struts of each stage"));
  EXPECT_THAT(result_denied([&](json& r) {
                sizes(r, "initial", "lengths_mm")[1] =
                    1.001 * sizes(r, "initial", "lengths_mm")[1].get<double>();
              }),
              Contains("sizing moves no node"));
  EXPECT_THAT(result_denied([&](json& r) {
                for (json& radius : sizes(r, "initial", "radii_mm")) radius = 5;
              }),
              Contains("radii of each stage"));
  EXPECT_THAT(result_denied([](json& r) { r["given"]["nodes"][3][2] = 99; }),
              Contains("sizing moves no node"));
}

TEST_F(SolutionTest, LowerBoundsAreVerifiedForTheFrameThatWasGiven) {
  solve(standing_tripod());
  using ::testing::Contains;
  const Names proven = {"lower bound of the sized volume, proven"};
  const double bound = read("report.json")["frame"]["lower_bound_mm3"];
  EXPECT_THAT(report_denied([&](json& f) { f["lower_bound_mm3"] = 1.0001 * bound; }), Contains(proven[0]));
  EXPECT_THAT(result_denied([](json& r) { r["lower_bound_proof"] = nullptr; }), proven);
  EXPECT_THAT(result_denied([](json& r) { r["lower_bound_proof"]["fields"] = json::array(); }), proven);
  EXPECT_THAT(result_denied([](json& r) { r["lower_bound_proof"]["feasibility_tolerance"] = 0.5; }), proven);
  EXPECT_THAT(result_denied([](json& r) { r["lower_bound_proof"]["volume_weight"] = 2; }), proven);
  EXPECT_THAT(
      result_denied([](json& r) { r["lower_bound_proof"]["fields"][0]["displacement_multiplier"] = -1.0; }),
      proven);
  EXPECT_THAT(result_denied([](json& r) {
                for (json& d : r["lower_bound_proof"]["fields"][0]["displacements_mm"]) d[2] = 0.0;
              }),
              proven);
  EXPECT_THAT(result_denied([](json& r) { r["given"]["load_cases"][0]["forces"] = json::array(); }),
              Contains(proven[0]));
  EXPECT_THAT(result_denied([](json& r) { r["lower_bound_proof"]["fields"][0]["load_case"] = 7; }),
              Contains(::testing::HasSubstr("7 is not a load case")));
}

TEST_F(SolutionTest, ACertificateOfInfeasibilityIsVerified) {
  json weak = standing_tripod();
  weak["load_cases"][0]["forces"][0]["force_n"] = {0, 0, -1e5};
  solve(weak);
  using ::testing::Contains;
  const std::string proven = "no radii keep the limits";
  EXPECT_THAT(report_denied([](json&) {}), ::testing::IsEmpty());
  EXPECT_THAT(result_denied([](json& r) { r["certificate"] = nullptr; }), Contains(proven));
  EXPECT_THAT(result_denied([](json& r) { r["displacement_limit_mm"] = 1e4; }), Contains(proven));
  EXPECT_THAT(result_denied([](json& r) {
                for (json& strut : r["struts"]) strut["max_radius_mm"] = 1e4;
              }),
              Contains(proven));
  EXPECT_THAT(result_denied([](json& r) {
                for (json& d : r["certificate"]["fields"][0]["displacements_mm"]) d = {0.0, 0.0, 0.0};
              }),
              Contains(proven));
}

TEST_F(SolutionTest, APinJointedFrameIsJudgedByItsOwnModel) {
  solve(skinframe::testing::sample_problem());
  for (const Claim& claim : claims()) EXPECT_TRUE(claim.holds) << claim.name << ": " << claim.measured;
  EXPECT_THAT(result_denied([](json& r) { r["mechanics"] = "paper"; }),
              ::testing::Contains("equilibrium (paper model)"));
  EXPECT_THAT(result_denied([](json& r) { r["mechanics"] = "beam"; }),
              ::testing::Contains(::testing::HasSubstr("\"beam\"")));
}

TEST_F(SolutionTest, WhatIsCalledInfeasibleHasToBreakTheConstraintThatItNames) {
  json weak = standing_tripod();
  weak["load_cases"][0]["forces"][0]["force_n"] = {0, 0, -1e5};
  solve(weak);
  for (const Claim& claim : claims()) EXPECT_TRUE(claim.holds) << claim.name << ": " << claim.measured;
  EXPECT_THAT(report_denied([](json& f) { f["termination"]["violated_constraint"] = "balance"; }),
              ::testing::Contains("infeasible"));
  EXPECT_THAT(report_denied([](json& f) { f["termination"]["best_reachable_displacement_mm"] = 0.06; }),
              ::testing::Contains("best reachable displacement (paper model)"));
}

}  // namespace
}  // namespace skinframe::check
