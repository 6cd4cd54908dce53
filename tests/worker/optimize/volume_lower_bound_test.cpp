// SPDX-License-Identifier: GPL-3.0-or-later
// The bound on problems whose optimum is worked out by hand, and against frames that are feasible.
#include "worker/optimize/volume_lower_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/worker/mechanics/small_frames.h"
#include "tests/worker/optimize/test_frames.h"
#include "worker/mechanics/evaluation.h"
#include "worker/optimize/design.h"
#include "worker/optimize/optimize_frame.h"

namespace skinframe {
namespace {

using std::numbers::pi;
using testing::bare_problem;
using testing::chain;
using testing::Egg;
using testing::load_at;
using testing::make_egg;
using testing::size_only;
using testing::ten_bar_truss;
using testing::top_load;
using testing::two_strut_truss;

VolumeBound bound_of(const FrameProblem& problem, const std::vector<double>& start_mm2,
                     const std::vector<bool>& may_vanish = {}, double volume_mm3 = 1e300) {
  BoundRequest request;
  request.box = area_box(problem, may_vanish);
  request.start_mm2 = start_mm2;
  request.volume_mm3 = volume_mm3;
  return volume_lower_bound(problem, request);
}

std::vector<double> uniform(const FrameProblem& problem, double area_mm2) {
  return std::vector<double>(problem.frame.struts.size(), area_mm2);
}

FrameProblem loaded_egg(const Eigen::Vector3d& force_n = {0, 20, 0}) {
  FrameProblem problem = make_egg(Egg{});
  problem.load_cases = {top_load(problem, "side", force_n)};
  return problem;
}

// One strut: u = F l / (gamma A) = epsilon, no slack anywhere.
TEST(VolumeLowerBound, OfOneStrutIsItsOptimum) {
  FrameProblem problem = chain(1, 100);
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 1, {8, 0, 0})};
  const double optimum = 100 * 8 * 100 / (1586 * 0.05);
  const double bound = bound_of(problem, uniform(problem, 20)).value_mm3;
  EXPECT_LE(bound, optimum);
  EXPECT_GT(bound, (1 - 1e-4) * optimum);
}

// One loaded node, its displacement along the force: the relaxation is the problem itself.
TEST(VolumeLowerBound, OfAPulledChainAndATwoStrutTrussIsTheirOptimum) {
  FrameProblem pulled = chain(4, 100);
  pulled.displacement_limit_mm = 0.05;
  pulled.load_cases = {load_at(pulled, 4, {8, 0, 0})};
  FrameProblem truss = two_strut_truss(30, 40);
  truss.displacement_limit_mm = 0.05;
  truss.load_cases = {load_at(truss, 2, {0, 0, -20})};
  const double of_chain = 100 * 8 * 100 / (1586 * 0.05);
  const double of_truss = 2 * 50 * 20 * 50 / (2 * 1586 * 0.05 * 0.64);
  for (const auto& [problem, optimum] : {std::pair(&pulled, of_chain), std::pair(&truss, of_truss)}) {
    const double bound = bound_of(*problem, uniform(*problem, 30)).value_mm3;
    EXPECT_LE(bound, optimum);
    EXPECT_GT(bound, (1 - 1e-4) * optimum);
  }
}

// A hanging strut under its own weight and a pull: u = l (F + w A l / 2) / (gamma A) = epsilon, w = rho g.
TEST(VolumeLowerBound, CountsTheWeightOfTheStruts) {
  FrameProblem problem = bare_problem({{0, 0, 100}, {0, 0, 0}}, {{0, 1}});
  problem.fixed[0] = {true, true, true};
  problem.material.density_g_cm3 = 400;
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 1, {0, 0, -10}, true)};
  const double half_weight = 400 * 1e-9 * 9810 * 100 / 2;  // N per mm2
  const double optimum = 100 * 10 * 100 / (1586 * 0.05 - half_weight * 100);
  const double bound = bound_of(problem, uniform(problem, 30)).value_mm3;
  EXPECT_LE(bound, optimum);
  EXPECT_GT(bound, (1 - 1e-4) * optimum);
}

// Pin-jointed, sigma = 5 MPa and no displacement limit: A = F / (2 sin sigma), all material fully stressed.
TEST(VolumeLowerBound, KnowsTheStressLimitWhereNothingElseLimits) {
  FrameProblem problem = two_strut_truss(30, 40);
  problem.material.tensile_strength_mpa = 5;
  problem.load_cases = {load_at(problem, 2, {0, 0, -200})};
  const double optimum = 2 * 50 * 200 / (2 * 0.8 * 5);
  const double bound = bound_of(problem, uniform(problem, 40)).value_mm3;
  EXPECT_LE(bound, optimum);
  EXPECT_GT(bound, (1 - 1e-4) * optimum);
}

// In inches, kips, ksi: displacements of 2 in, then stress 25 ksi. Published: 5060.9 lb with both, 1593.2 lb
// with stress alone, at 0.1 lb/in3.
TEST(VolumeLowerBound, StaysBelowThePublishedTenBarOptima) {
  FrameProblem problem = ten_bar_truss();
  const double of_stress = 0.1 * bound_of(problem, uniform(problem, 10)).value_mm3;
  EXPECT_LE(of_stress, 1593.2);
  EXPECT_GT(of_stress, 0.9 * 1593.2);
  problem.displacement_limit_mm = 2;
  const OptimizeResult both = size_only(problem);
  const double of_both = 0.1 * bound_of(problem, areas_of(both.radii_mm)).value_mm3;
  EXPECT_LE(of_both, 0.1 * both.size.volume_mm3);
  EXPECT_GT(of_both, 0.7 * 5060.9) << "two loaded nodes, of which one alone reaches its limit";
}

TEST(VolumeLowerBound, EnclosesTheOptimumOfFramesWithinAFewPercent) {
  for (const Eigen::Vector3d& force : {Eigen::Vector3d(0, 20, 0), Eigen::Vector3d(20, 0, -10)}) {
    const FrameProblem problem = loaded_egg(force);
    const OptimizeResult r = size_only(problem);
    ASSERT_EQ(r.reason, Termination::kOptimal);
    const double bound = bound_of(problem, areas_of(r.radii_mm), {}, r.size.volume_mm3).value_mm3;
    EXPECT_LE(bound, r.size.volume_mm3);
    EXPECT_GT(bound, 0.9 * r.size.volume_mm3);
  }
}

TEST(VolumeLowerBound, IsWhatItsProofSays) {
  const FrameProblem problem = loaded_egg();
  const VolumeBound bound = bound_of(problem, uniform(problem, 5));
  const double proven = dual_value(problem, area_box(problem), bound.proof).value;
  EXPECT_LE(bound.value_mm3, proven);
  EXPECT_NEAR(bound.value_mm3, proven, 1e-9 * proven);
}

// Whatever the fields and multipliers are: nonsense proves less, never something false.
TEST(DualProof, HoldsForEveryFeasibleFrameWhateverTheField) {
  FrameProblem problem = loaded_egg();
  problem.balance = testing::base_hull(problem.frame, 0);
  const AreaBox box = area_box(problem);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::vector<CaseResponse> shape = solve_equilibrium(problem, uniform(problem, 6));
  std::vector<std::vector<double>> feasible;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<double> areas;
    for (std::size_t j = 0; j < box.lower_mm2.size(); ++j)
      areas.push_back(std::min(box.upper_mm2[j], box.lower_mm2[j] + 12 * unit(generator)));
    if (violated_constraint(evaluate(problem, radii_of(areas)), 0).empty()) feasible.push_back(areas);
  }
  ASSERT_GT(feasible.size(), 10u);
  for (int trial = 0; trial < 30; ++trial) {
    DualProof proof;
    proof.volume_weight = trial % 2;
    proof.balance_multipliers.assign(problem.balance.size(), 10 * unit(generator));
    VirtualField field{0, 1e4 * unit(generator), trial % 3 == 0 ? 1e4 * unit(generator) : 0.0, {}};
    for (const Eigen::Vector3d& d : shape[0].displacements_mm)
      field.displacements_mm.push_back(2 * unit(generator) * d +
                                       0.01 * unit(generator) * Eigen::Vector3d::Random());
    proof.fields = {field};
    const double value = dual_value(problem, box, proof).value;
    for (const auto& areas : feasible)
      EXPECT_LE(value, proof.volume_weight * frame_volume_mm3(problem.frame, radii_of(areas)) + 1e-6);
  }
}

TEST(VolumeLowerBound, NoFeasibleFrameIsBelowIt) {
  const FrameProblem problem = loaded_egg();
  const OptimizeResult r = size_only(problem);
  const std::vector<double> best = areas_of(r.radii_mm);
  const AreaBox box = area_box(problem);
  const double bound = bound_of(problem, best).value_mm3;
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> unit(0, 1);
  int feasible = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<double> areas = best;
    for (std::size_t j = 0; j < areas.size(); ++j)
      areas[j] = std::clamp(areas[j] * (0.98 + 0.1 * unit(generator)), box.lower_mm2[j], box.upper_mm2[j]);
    if (!violated_constraint(evaluate(problem, radii_of(areas)), 1e-6).empty()) continue;
    ++feasible;
    EXPECT_LE(bound, frame_volume_mm3(problem.frame, radii_of(areas)));
  }
  EXPECT_GT(feasible, 10);
}

// Removable struts may vanish: the bound holds for what topology optimisation leaves, with its struts
// removed.
TEST(VolumeLowerBound, WithStrutsThatMayVanishHoldsForReducedFrames) {
  const FrameProblem problem = loaded_egg();
  const std::vector<bool> removable = removable_struts(problem);
  OptimizeOptions options;
  options.geometry = false;
  RunContext context;
  auto reduced = optimize_frame(problem, options, context);
  ASSERT_TRUE(reduced.ok());
  ASSERT_LT(reduced->topology.struts, reduced->size.struts);
  const double bound = bound_of(problem, areas_of(size_only(problem).radii_mm), removable).value_mm3;
  EXPECT_LE(bound, reduced->topology.volume_mm3);
  EXPECT_GT(bound, 0.8 * reduced->topology.volume_mm3);
}

TEST(VolumeLowerBound, SeveralLoadCasesRaiseIt) {
  FrameProblem problem = loaded_egg();
  const double one = bound_of(problem, uniform(problem, 6)).value_mm3;
  problem.load_cases.push_back(top_load(problem, "other", {20, 0, 0}));
  const OptimizeResult r = size_only(problem);
  const double two = bound_of(problem, areas_of(r.radii_mm)).value_mm3;
  EXPECT_GT(two, (1 + 1e-3) * one);
  EXPECT_LE(two, r.size.volume_mm3);
}

TEST(VolumeLowerBound, WithoutAnyLimitIsEveryStrutAtItsLowerBound) {
  FrameProblem problem = chain(2, 100);
  problem.load_cases = {load_at(problem, 2, {8, 0, 0})};
  EXPECT_NEAR(bound_of(problem, uniform(problem, 20)).value_mm3, 100 * pi * 0.25, 1e-9);
}

}  // namespace
}  // namespace skinframe
