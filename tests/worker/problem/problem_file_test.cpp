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
        BadField{[](json& d) { d = json::array(); }, "problem: must be an object"},
        BadField{[](json& d) { d["mechanics"] = nullptr; }, "mechanics: must be a string"},
        BadField{[](json& d) { d.erase("mechanics"); }, "mechanics: is missing"},
        BadField{[](json& d) { d["mechanics"] = "timoshenko"; }, "use \"paper\" or \"axial\""},
        BadField{[](json& d) { d["material"] = 3; }, "material: must be an object"},
        BadField{[](json& d) { d["material"].erase("tensile_modulus_mpa"); },
                 "material.tensile_modulus_mpa: is missing"},
        BadField{[](json& d) { d["material"]["tensile_modulus_mpa"] = 0; },
                 "material.tensile_modulus_mpa: must be positive"},
        BadField{[](json& d) {
                   d["mechanics"] = "paper";
                   d["material"].erase("shear_modulus_mpa");
                 },
                 "material.shear_modulus_mpa: is missing"},
        BadField{[](json& d) { d["material"]["tensile_strength_mpa"] = "strong"; },
                 "material.tensile_strength_mpa: must be a number"},
        BadField{[](json& d) { d["material"]["shear_strength_mpa"] = 0; },
                 "material.shear_strength_mpa: must be positive, or null"},
        BadField{[](json& d) { d["material"]["slenderness"] = -60; },
                 "material.slenderness: must be positive"},
        BadField{[](json& d) { d["material"]["density_g_cm3"] = -1; },
                 "material.density_g_cm3: must not be negative"},
        BadField{[](json& d) {
                   d["nodes"] = {{"x", 1}};
                 },
                 "nodes: must be a list"},
        BadField{[](json& d) { d["nodes"][3] = d["nodes"][2]; }, "struts[4]: its ends 2 and 3 coincide"},
        BadField{[](json& d) { d["struts"][5] = 7; }, "struts[5]: must be an object"},
        BadField{[](json& d) { d["struts"][0]["skin"] = 1; }, "struts[0].skin: must be true or false"},
        BadField{[](json& d) { d["struts"][0]["b"] = 4294967296; }, "struts[0].b: 4294967296 is not a node"},
        BadField{[](json& d) { d["struts"][2]["min_radius_mm"] = 6; }, "struts[2]: radius bounds 6..5"},
        BadField{[](json& d) { d["struts"][2]["min_radius_mm"] = -1; }, "struts[2]: radius bounds"},
        BadField{[](json& d) { d["struts"][2]["max_radius_mm"] = nullptr; },
                 "struts[2].max_radius_mm: must be a number"},
        BadField{[](json& d) {
                   d["struts"][5]["a"] = 1;
                   d["struts"][5]["b"] = 0;
                 },
                 "struts[5]: joins nodes 0 and 1, as struts[0] does already"},
        BadField{[](json& d) { d["struts"] = json::array(); }, "struts"},
        BadField{[](json& d) {
                   d["skin_triangles"] = {{0, 1}};
                 },
                 "skin_triangles[0]: must name three nodes"},
        BadField{[](json& d) {
                   d["skin_triangles"] = {{0, 1, 4}};
                 },
                 "skin_triangles[0][2]: 4 is not a node"},
        BadField{[](json& d) {
                   d["skin_weight_n"] = {1, 2};
                 },
                 "skin_weight_n: 2 entries for 4 nodes"},
        BadField{[](json& d) {
                   d["skin_weight_n"] = {0, 0, 0, -1};
                 },
                 "skin_weight_n[3]: must not be negative"},
        BadField{[](json& d) {
                   d["skin_mass"] = {{"weight_n", 1}};
                 },
                 "skin_mass.centroid_mm: is missing"},
        BadField{
            [](json& d) { d["balance_half_planes"] = json::parse(R"([{"normal":[1,1],"offset_mm":0}])"); },
            "balance_half_planes[0]: the normal must be of unit length"},
        BadField{[](json& d) { d["fixed"] = nullptr; }, "fixed: must be a list"},
        BadField{[](json& d) { d["fixed"][0].erase("axes"); }, "fixed[0].axes: is missing"},
        BadField{[](json& d) { d["load_cases"][0]["gravity"] = "yes"; },
                 "load_cases[0].gravity: must be true or false"},
        BadField{[](json& d) { d["load_cases"][0]["name"] = 7; }, "load_cases[0].name: must be a string"},
        BadField{[](json& d) { d["load_cases"][0]["forces"][0]["node"] = 9; },
                 "load_cases[0].forces[0].node: 9 is not a node (0..3)"},
        BadField{[](json& d) { d["load_cases"][0]["forces"][0].erase("force_n"); },
                 "load_cases[0].forces[0].force_n: is missing"},
        BadField{[](json& d) {
                   while (d["nodes"].size() < 10'001) d["nodes"].push_back({1.0 * d["nodes"].size(), 0, 9});
                   d["load_cases"] = json(1000, json::object());
                 },
                 "load_cases: 1000 entries, at most 999 are taken"},
        BadField{[](json& d) { d["displacement_limit_mm"] = true; },
                 "displacement_limit_mm: must be a number"},
        BadField{[](json& d) { d["free_nodes"] = {7}; }, "free_nodes[0]: 7 is not a node (0..3)"},
        BadField{[](json& d) { d["free_nodes"] = {3}; }, "free_nodes: node 3 is loaded"},
        BadField{[](json& d) { d["stages"] = "size"; }, "stages: must be a list"}));

TEST(ProblemFile, WhatIsNullIsOff) {
  json document = sample_problem();
  for (const char* limit : {"tensile_strength_mpa", "shear_strength_mpa", "slenderness"})
    document["material"][limit] = nullptr;
  document["displacement_limit_mm"] = nullptr;
  document["skin_weight_n"] = document["balance_half_planes"] = document["stages"] = document["order"] =
      nullptr;
  const auto file = parse_problem(document);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_FALSE(file->problem.material.tensile_strength_mpa);
  EXPECT_FALSE(file->problem.material.slenderness);
  EXPECT_FALSE(file->problem.displacement_limit_mm);
  EXPECT_TRUE(file->options.geometry);
}

// Such files take gigabytes once they are a tree.
TEST(ProblemFile, DepthAndNumberOfValuesAreBoundedBeforeATreeIsMade) {
  const std::string path = ::testing::TempDir() + "deep-problem.json";
  std::ofstream(path) << "{\"x\": " << std::string(1'000'000, '[');
  const auto deep = read_problem(path, "deep.json");
  ASSERT_FALSE(deep.ok());
  EXPECT_EQ(deep.error().message, "deep.json: nested more than 16 deep");
  {
    std::ofstream wide(path);
    wide << "{\"x\": [";
    const std::string zeros = [] {
      std::string text;
      for (int i = 0; i < 1'000'000; ++i) text += "0,";
      return text;
    }();
    for (int i = 0; i < 31; ++i) wide << zeros;
    wide << "0]}";
  }
  const auto wide = read_problem(path, "wide.json");
  ASSERT_FALSE(wide.ok());
  EXPECT_EQ(wide.error().message, "wide.json: more than 30000000 values");
  std::ofstream(path) << "{\"x\": 1e999}";
  EXPECT_THAT(read_problem(path, "large.json").error().message, HasSubstr("not valid JSON"));
  std::filesystem::remove(path);
}

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
