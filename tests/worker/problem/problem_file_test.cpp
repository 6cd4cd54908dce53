// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/problem_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "tests/worker/problem/sample_problem.h"

namespace skinframe {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::sample_problem;

TEST(ProblemFile, EveryFieldArrives) {
  const auto file = parse_problem(sample_problem());
  ASSERT_TRUE(file.ok()) << file.error().message;
  const FrameProblem& p = file->problem;
  EXPECT_EQ(p.element, ElementModel::kAxial);
  EXPECT_EQ(p.material.tensile_modulus_mpa, 1586);
  EXPECT_EQ(p.material.tensile_strength_mpa, 43);
  EXPECT_FALSE(p.material.shear_strength_mpa.has_value());
  EXPECT_EQ(p.frame.nodes_mm.size(), 4u);
  EXPECT_TRUE(p.frame.struts[0].is_skin);
  EXPECT_EQ(p.bounds[2].max_mm, 5);
  EXPECT_EQ(p.fixed[1], (std::array<bool, 3>{true, false, true}));
  EXPECT_FALSE(p.load_cases[0].gravity);
  EXPECT_EQ(p.load_cases[0].force_n[3], Eigen::Vector3d(0, 0, -20));
  EXPECT_EQ(p.displacement_limit_mm, 0.05);
  EXPECT_FALSE(file->options.geometry);
  EXPECT_TRUE(file->options.topology);
}

TEST(ProblemFile, WhatIsWrittenIsReadBack) {
  FrameProblem problem = parse_problem(sample_problem())->problem;
  problem.skin_weight_n = {0.25, 0.5, 0, 0};
  problem.skin_mass = {3.5, {1, 2, 3}};
  problem.balance = {{{0.6, 0.8}, 12}};
  problem.frame.skin_triangles = {{0, 1, 2}};
  const json document = to_json(problem, {1, 2, 3, 4, 5, 6}, {std::vector<Eigen::Vector3d>(4, {1, 2, 3})});
  const auto again = parse_problem(json::parse(document.dump()));
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(to_json(again->problem, {1, 2, 3, 4, 5, 6}, {std::vector<Eigen::Vector3d>(4, {1, 2, 3})}),
            document);
  EXPECT_EQ(document["struts"][4]["radius_mm"], 5);
  EXPECT_EQ(document["load_cases"][0]["displacements_mm"][3], json({1, 2, 3}));
}

struct BadField {
  std::function<void(json&)> spoil;
  std::string message;
};

class BadProblemFile : public ::testing::TestWithParam<BadField> {};

TEST_P(BadProblemFile, IsRefusedNamingTheField) {
  json document = sample_problem();
  GetParam().spoil(document);
  const auto file = parse_problem(document);
  ASSERT_FALSE(file.ok()) << GetParam().message;
  EXPECT_THAT(file.error().message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Fields, BadProblemFile,
    ::testing::Values(
        BadField{[](json& d) { d["struts"][3]["a"] = 900; }, "struts[3].a: 900 is not a node (0..3)"},
        BadField{[](json& d) { d["struts"][3]["b"] = -1; }, "struts[3].b: -1 is not a node (0..3)"},
        BadField{[](json& d) { d["struts"][0]["a"] = 1.5; }, "struts[0].a: must be a whole number"},
        BadField{[](json& d) { d["struts"][2]["b"] = d["struts"][2]["a"]; }, "struts[2]"},
        BadField{[](json& d) {
                   d["nodes"][2] = {1, 2};
                 },
                 "nodes[2]: must be a list of 3 numbers"},
        BadField{[](json& d) { d["nodes"][2][1] = "x"; }, "nodes[2][1]: must be a number"},
        BadField{[](json& d) { d["nodes"] = json::array(); }, "nodes: there are none"},
        BadField{[](json& d) { d.erase("struts"); }, "struts: is missing"},
        BadField{[](json& d) { d["struts"][1].erase("max_radius_mm"); },
                 "struts[1].max_radius_mm: is missing"},
        BadField{[](json& d) { d["mechanics"] = "beam"; }, "mechanics: \"beam\" is not built"},
        BadField{[](json& d) { d["material"]["density_g_cm3"] = nullptr; },
                 "material.density_g_cm3: must be a number"},
        BadField{[](json& d) { d["fixed"][0]["axes"] = "xw"; }, "fixed[0].axes: 'w' is not an axis"},
        BadField{[](json& d) { d["fixed"][1]["node"] = 4; }, "fixed[1].node: 4 is not a node"},
        BadField{[](json& d) {
                   d["load_cases"][0]["forces"][0]["force_n"] = {1, 2, nullptr};
                 },
                 "load_cases[0].forces[0].force_n[2]: must be a number"},
        BadField{[](json& d) { d["displacement_limit_mm"] = -1; }, "displacement_limit_mm: must be positive"},
        BadField{[](json& d) {
                   d["stages"] = {"size", "shape"};
                 },
                 "stages[1]: \"shape\" is not a stage"},
        BadField{[](json& d) { d["stages"] = {"geometry"}; }, "stages: \"size\" must be among them"},
        BadField{[](json& d) { d["order"] = "any"; }, "order: \"any\""},
        BadField{[](json& d) { d["free_nodes"] = {0}; }, "free_nodes: node 0 is fixed"},
        // 6 * 20000 nodes + 6 struts: 50e6 entries are 416 rows.
        BadField{[](json& d) {
                   while (d["nodes"].size() < 20'000) d["nodes"].push_back({1.0 * d["nodes"].size(), 0, 9});
                   d["balance_half_planes"] = json(417, json{{"normal", {1, 0}}, {"offset_mm", 9}});
                 },
                 "balance_half_planes: 417 entries, at most 416 are taken"},
        BadField{[](json& d) { d = json::array(); }, "problem: must be an object"}));

TEST(ProblemFile, MissingFileAndBrokenJsonAreOneSentence) {
  const auto missing = read_problem(::testing::TempDir() + "there-is-no-such-problem.json");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().kind, ErrorKind::kIo);
  const std::string path = ::testing::TempDir() + "broken-problem.json";
  std::ofstream(path) << "{\"nodes\": [";
  const auto broken = read_problem(path);
  ASSERT_FALSE(broken.ok());
  EXPECT_EQ(broken.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(broken.error().message, HasSubstr("not valid JSON"));
}

}  // namespace
}  // namespace skinframe
