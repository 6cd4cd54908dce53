// SPDX-License-Identifier: GPL-3.0-or-later
// The check says no to each lie told in a copy of an honest frame, and to the paper model's figures that it
// lacks.
#include <array>
#include <cmath>

#include "tests/worker/check/honest_result.h"

namespace skinframe::check {
namespace {

TEST_F(CheckTest, AStrutThinnerThanThePrinterCanIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["struts"][3]["radius_mm"] = 0.4; }), Names("radii"));
}

TEST_F(CheckTest, AStrutTooThickForTheSkinIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["struts"][3]["radius_mm"] = 1.6; }), Names("radii"));
}

// A strut of the radius given that runs 3 mm below the first skin strut.
void add_internal_strut(json& frame, double radius_mm) {
  json& nodes = frame["nodes"];
  const auto count = nodes.size();
  std::array<double, 3> centre{};
  for (const json& node : nodes)
    for (int k = 0; k < 3; ++k) centre[k] += node[k].get<double>() / static_cast<double>(count);
  for (const char* end : {"a", "b"}) {
    json node = nodes[frame["struts"][0][end].get<std::size_t>()];
    double distance = 0;
    for (int k = 0; k < 3; ++k) distance += std::pow(centre[k] - node[k].get<double>(), 2);
    for (int k = 0; k < 3; ++k)
      node[k] = node[k].get<double>() + 3 / std::sqrt(distance) * (centre[k] - node[k].get<double>());
    nodes.push_back(node);
    frame["skin_weight_n"].push_back(0.0);
    for (json& load_case : frame["load_cases"]) load_case["displacements_mm"].push_back({0.0, 0.0, 0.0});
  }
  frame["struts"].push_back({{"a", count},
                             {"b", count + 1},
                             {"skin", false},
                             {"radius_mm", radius_mm},
                             {"min_radius_mm", 0.5},
                             {"max_radius_mm", 5.0}});
}

TEST_F(CheckTest, AnInternalStrutThatStandsOutOfTheInsideByItsRadiusIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { add_internal_strut(frame, 5.0); }),
              Names("internal struts inside the skin"));
  EXPECT_THAT(denied_frame([](json& frame) { add_internal_strut(frame, 0.5); }),
              testing::Not(Names("internal struts inside the skin")));
}

TEST_F(CheckTest, ASlenderStrutIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["material"]["slenderness"] = 5; }), Names("slenderness"));
}

TEST_F(CheckTest, ATornTriangulationIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["skin_triangles"].erase(0); }),
              Names("skin triangulation"));
}

TEST_F(CheckTest, AMovedNodeBreaksEquilibrium) {
  EXPECT_THAT(
      denied_frame([](json& frame) { frame["nodes"][20][0] = frame["nodes"][20][0].get<double>() + 1.0; }),
      Names("equilibrium (paper model)"));
}

TEST_F(CheckTest, AFalseDisplacementIsSeen) {
  EXPECT_THAT(
      denied_report([](json& p) { p["max_displacement_mm"] = 0.5 * p["max_displacement_mm"].get<double>(); }),
      Names("displacement (paper model)"));
}

TEST_F(CheckTest, ALimitThatIsNotKeptIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["displacement_limit_mm"] = 1e-4; }),
              Names("displacement (paper model)"));
}

TEST_F(CheckTest, AStressBeyondStrengthIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["material"]["tensile_strength_mpa"] = 1e-3; }),
              Names("stresses (paper model)"));
}

TEST_F(CheckTest, ACentreOfGravityOutsideTheBaseIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) {
                frame["skin_mass"]["centroid_mm"] = {500, 0, 10};
              }),
              Names("balance"));
}

TEST_F(CheckTest, AMarginOfThePrintThatTheMeshDoesNotHaveIsSeen) {
  EXPECT_THAT(denied_report([](json& p) { p["printed_balance_margin_mm"] = 99; }), Names("balance"));
  EXPECT_THAT(denied_report([](json& p) { p.erase("printed_balance_margin_mm"); }), Names("balance"));
}

TEST_F(CheckTest, ALowerBoundIsVerifiedForTheFrameThatWasOptimised) {
  const json honest_report = read_json(honest() / "report.json");
  const double bound = honest_report["printers"][0]["lower_bound_mm3"];
  const char* proven = "lower bound of the sized volume, proven";
  EXPECT_THAT(denied_report([&](json& p) { p["lower_bound_mm3"] = 1.0001 * bound; }), Names(proven));
  const auto denied_initial = [&](const std::function<void(json&)>& lie) {
    return denied([&](const fs::path& copy) {
      json initial = read_json(copy / kPrinter / "initial-frame.json");
      lie(initial);
      write_json(copy / kPrinter / "initial-frame.json", initial);
    });
  };
  EXPECT_THAT(denied_initial([](json& f) { f["lower_bound_proof"] = nullptr; }), Names(proven));
  EXPECT_THAT(denied_initial([](json& f) { f["displacement_limit_mm"] = 0.01; }), Names(proven));
}

TEST_F(CheckTest, ANodeWithoutAPathToTheBaseIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) {
                frame["nodes"].push_back({0, 0, 20});
                frame["skin_weight_n"].push_back(0.0);
              }),
              Names("every node stands on the base"));
}

TEST_F(CheckTest, AMeshWithoutTheStrutsIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) {
                // Struts that run through the void: from one skin node straight across the body.
                frame["struts"].push_back({{"a", 0},
                                           {"b", 30},
                                           {"skin", false},
                                           {"radius_mm", 0.6},
                                           {"min_radius_mm", 0.5},
                                           {"max_radius_mm", 5}});
              }),
              Names("struts are printed"));
}

TEST_F(CheckTest, AResultCalledInfeasibleThatKeepsItsLimitsIsSeen) {
  EXPECT_THAT(denied_report([](json& printer) {
                printer["termination"]["reason"] = "INFEASIBLE";
                printer["violated_constraint"] = "displacement";
              }),
              Names("infeasible"));
}

}  // namespace
}  // namespace skinframe::check
