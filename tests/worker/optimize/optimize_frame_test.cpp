// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/optimize_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <stop_token>

#include "tests/worker/mechanics/small_frames.h"
#include "tests/worker/optimize/test_frames.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using testing::base_hull;
using testing::Egg;
using testing::make_egg;
using testing::top_load;

OptimizeResult optimised(const FrameProblem& problem, const OptimizeOptions& options = {}) {
  RunContext context;
  auto result = optimize_frame(problem, options, context);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return std::move(result).value();
}

FrameProblem loaded_egg() {
  FrameProblem problem = make_egg(Egg{});
  problem.load_cases = {top_load(problem, "side", {0, 20, 0})};
  return problem;
}

void expect_sound(const FrameProblem& input, const OptimizeResult& r) {
  EXPECT_EQ(violated_constraint(evaluate(r.problem, r.radii_mm), 1e-5), "");
  EXPECT_TRUE(validate(r.problem).ok());
  EXPECT_LE(r.topology.volume_mm3, (1 + kVolumeTie) * r.size.volume_mm3);
  EXPECT_LE(r.geometry.volume_mm3, (1 + kVolumeTie) * r.topology.volume_mm3);
  EXPECT_NEAR(frame_volume_mm3(r.problem.frame, r.radii_mm), r.geometry.volume_mm3,
              1e-9 * r.geometry.volume_mm3);
  ASSERT_EQ(r.node_origin.size(), r.problem.frame.nodes_mm.size());
  ASSERT_EQ(r.strut_origin.size(), r.problem.frame.struts.size());
  const auto stands = [&](int origin) {
    return std::find(r.node_origin.begin(), r.node_origin.end(), origin) != r.node_origin.end();
  };
  for (std::size_t j = 0; j < r.strut_origin.size(); ++j) {
    const Strut &now = r.problem.frame.struts[j], &then = input.frame.struts[r.strut_origin[j]];
    for (const auto& [end, origin] : {std::pair{now.a, then.a}, std::pair{now.b, then.b}})
      EXPECT_TRUE(r.node_origin[end] == origin || (input.free_nodes[origin] && !stands(origin)))
          << "an end is the input's, or that end has become one with another node";
  }
  for (std::size_t i = 0; i < r.node_origin.size(); ++i)
    if (!input.free_nodes[r.node_origin[i]]) {
      EXPECT_EQ(r.problem.frame.nodes_mm[i], input.frame.nodes_mm[r.node_origin[i]])
          << "skin nodes do not move";
    }
}

TEST(OptimizeFrame, BothOrdersEndInASoundSmallerFrame) {
  const FrameProblem problem = loaded_egg();
  for (auto order : {OptimizeOptions::Order::kTight, OptimizeOptions::Order::kPaper}) {
    OptimizeOptions options;
    options.order = order;
    const OptimizeResult r = optimised(problem, options);
    EXPECT_EQ(r.reason, Termination::kOptimal);
    expect_sound(problem, r);
    EXPECT_LT(r.geometry.volume_mm3, r.size.volume_mm3);
    EXPECT_LT(r.geometry.struts, r.size.struts);
  }
}

TEST(OptimizeFrame, WithoutExternalLoadTheFrameIsTheSkin) {
  FrameProblem problem = make_egg(Egg{});
  problem.load_cases = {top_load(problem, "self", Vector3d::Zero())};
  const OptimizeResult r = optimised(problem);
  EXPECT_EQ(r.reason, Termination::kOptimal);
  EXPECT_EQ(r.geometry.nodes, problem.frame.skin_node_count);
  EXPECT_EQ(r.geometry.struts, 3 * problem.frame.skin_node_count - 6);
  EXPECT_EQ(r.detail.find("global optimum"), std::string::npos)
      << "struts are gone: nothing is known of all frames";
  expect_sound(problem, r);
}

TEST(OptimizeFrame, SameProblemTwiceGivesTheSameBits) {
  const FrameProblem problem = loaded_egg();
  const OptimizeResult a = optimised(problem), b = optimised(problem);
  EXPECT_EQ(a.radii_mm, b.radii_mm);
  EXPECT_EQ(a.problem.frame.nodes_mm, b.problem.frame.nodes_mm);
  EXPECT_EQ(a.displacements_mm, b.displacements_mm);
}

// Loads, supports and frame turned about z, through all stages: the same struts and radii; nodes and
// displacements turned.
TEST(OptimizeFrame, TurningTheProblemAboutZTurnsTheAnswer) {
  FrameProblem problem = make_egg(Egg{2, 10, 7, 150, 1.0});
  problem.load_cases = {top_load(problem, "side", {0, 15, 0})};
  for (auto& axes : problem.fixed)
    if (axes[2]) axes = {true, true, true};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).toRotationMatrix();
  FrameProblem turned = problem;
  for (Vector3d& p : turned.frame.nodes_mm) p = turn * p;
  for (Vector3d& f : turned.load_cases[0].force_n) f = turn * f;
  turned.skin_mass.centroid_mm = turn * turned.skin_mass.centroid_mm;
  OptimizeOptions options;
  options.kkt_tolerance = 1e-9;  // the answers are alike to a thousandth of what is asked of them
  const OptimizeResult a = optimised(problem, options), b = optimised(turned, options);
  ASSERT_LT(a.geometry.volume_mm3, a.topology.volume_mm3);  // nodes were moved
  ASSERT_EQ(a.strut_origin, b.strut_origin);
  EXPECT_NEAR(a.geometry.volume_mm3, b.geometry.volume_mm3, 1e-6 * a.geometry.volume_mm3);
  for (int i = 0; i < a.problem.frame.skin_node_count; ++i)
    EXPECT_LT((turn * a.displacements_mm[0][i] - b.displacements_mm[0][i]).norm(), 1e-6 * 0.05) << i;
  // Where a node of a straight chain of equal struts stands on it is all the same, and free: directions are
  // not.
  const auto direction = [](const OptimizeResult& r, std::size_t j) {
    const Strut& strut = r.problem.frame.struts[j];
    return Vector3d((r.problem.frame.nodes_mm[strut.b] - r.problem.frame.nodes_mm[strut.a]).normalized());
  };
  for (std::size_t j = 0; j < a.radii_mm.size(); ++j) {
    EXPECT_NEAR(a.radii_mm[j], b.radii_mm[j], 1e-6 * a.radii_mm[j]) << j;
    EXPECT_LT((turn * direction(a, j) - direction(b, j)).norm(), 1e-6) << j;
  }
}

TEST(OptimizeFrame, BalanceHoldsWhenItIsAskedFor) {
  FrameProblem problem = loaded_egg();
  problem.skin_mass.centroid_mm.x() += 25;  // a skin that leans
  problem.balance = base_hull(problem.frame, 0);
  ASSERT_LT(evaluate(problem, std::vector<double>(problem.bounds.size(), 0.5)).balance_margin_mm, 8);
  for (HalfPlane& edge : problem.balance) edge.offset_mm -= 12;
  const OptimizeResult r = optimised(problem);
  ASSERT_EQ(r.reason, Termination::kOptimal) << r.detail;
  EXPECT_GE(r.evaluation.balance_margin_mm, -1e-5);
  expect_sound(problem, r);
}

TEST(OptimizeFrame, EveryLoadCaseHoldsInTheEnd) {
  FrameProblem problem = loaded_egg();
  problem.load_cases.push_back(top_load(problem, "other-side", {20, 0, 0}));
  problem.load_cases.push_back(top_load(problem, "down", {0, 0, -20}));
  const OptimizeResult r = optimised(problem);
  EXPECT_EQ(r.displacements_mm.size(), 3u);
  expect_sound(problem, r);
}

TEST(OptimizeFrame, InfeasibleEndsWithTheBestIterateAndItsName) {
  FrameProblem problem = make_egg(Egg{});
  problem.load_cases = {top_load(problem, "side", {0, 5000, 0})};
  const OptimizeResult r = optimised(problem);
  EXPECT_EQ(r.reason, Termination::kInfeasible);
  EXPECT_EQ(r.violated_constraint, "displacement");
  ASSERT_TRUE(r.best_reachable_displacement_mm.has_value());
  EXPECT_GT(*r.best_reachable_displacement_mm, 0.05);
  EXPECT_NEAR(evaluate(r.problem, r.radii_mm).max_displacement_mm, *r.best_reachable_displacement_mm, 1e-9);
}

TEST(TopOpt, RemovalTheCallerDoesNotAcceptIsDropped) {
  const FrameProblem problem = loaded_egg();
  OptimizeOptions options;
  options.geometry = false;
  ASSERT_LT(optimised(problem, options).topology.struts, static_cast<int>(problem.frame.struts.size()));
  options.accepts = [&](const Frame& frame, const std::vector<double>&) {
    return frame.struts.size() == problem.frame.struts.size();
  };
  const OptimizeResult r = optimised(problem, options);
  EXPECT_EQ(r.topology.struts, static_cast<int>(problem.frame.struts.size()));
  expect_sound(problem, r);
}

// Two struts in a bend, pulled at the free end; the middle node may move.
FrameProblem bent_chain() {
  FrameProblem problem = testing::bare_problem({{0, 0, 0}, {50, 12, 0}, {100, 0, 0}}, {{0, 1}, {1, 2}});
  problem.fixed[0] = {true, true, true};
  problem.fixed[2] = {false, true, true};
  problem.free_nodes = {false, true, false};
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {testing::load_at(problem, 2, {8, 0, 0})};
  return problem;
}

OptimizeOptions geometry_only() {
  OptimizeOptions options;
  options.relaxed = options.topology = false;
  return options;
}

// A bent chain pulled straight: the middle node moves onto the line, and the struts become the bar F L /
// (gamma epsilon).
TEST(GeoOpt, BentChainIsStraightened) {
  const OptimizeResult r = optimised(bent_chain(), geometry_only());
  EXPECT_NEAR(r.problem.frame.nodes_mm[1].y(), 0, 0.2);
  EXPECT_NEAR(r.geometry.volume_mm3, 100 * 8 * 100 / (1586 * 0.05), 1.0);
}

TEST(GeoOpt, NodeStaysInItsRegion) {
  const FrameProblem problem = bent_chain();
  OptimizeOptions options = geometry_only();
  options.convex_regions = [](const Frame& frame, const std::vector<double>&) {
    NodeRegions regions(frame.nodes_mm.size());
    regions[1] = {{-Vector3d::UnitY(), -7}};  // y >= 7
    return regions;
  };
  const OptimizeResult r = optimised(problem, options);
  EXPECT_GE(r.problem.frame.nodes_mm[1].y(), 7 - 1e-9);
  EXPECT_LT(r.problem.frame.nodes_mm[1].y(), 8);
}

TEST(GeoOpt, VetoLeavesEveryNodeWhereItStands) {
  const FrameProblem problem = loaded_egg();
  OptimizeOptions options;
  options.accepts = [](const Frame&, const std::vector<double>&) { return false; };
  const OptimizeResult r = optimised(problem, options);
  for (std::size_t i = 0; i < r.node_origin.size(); ++i)
    EXPECT_EQ(r.problem.frame.nodes_mm[i], problem.frame.nodes_mm[r.node_origin[i]]);
  EXPECT_EQ(r.geometry.volume_mm3, r.topology.volume_mm3);
}

TEST(OptimizeFrame, CancellationIsObeyedAtTheNextIteration) {
  const FrameProblem problem = loaded_egg();
  std::stop_source source;
  RunContext context;
  context.stop = source.get_token();
  int ticks = 0;
  context.report = [&](const Progress&) {
    if (++ticks == 3) source.request_stop();
  };
  const auto result = optimize_frame(problem, {}, context);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
  EXPECT_EQ(ticks, 3);
}

TEST(OptimizeFrame, BadOptionsAreRefusedByName) {
  OptimizeOptions options;
  options.region_share = 0;
  RunContext context;
  const auto result = optimize_frame(loaded_egg(), options, context);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("region_share"), std::string::npos);
}

}  // namespace
}  // namespace skinframe
