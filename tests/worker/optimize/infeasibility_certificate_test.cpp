// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/infeasibility_certificate.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/worker/mechanics/small_frames.h"
#include "tests/worker/optimize/test_frames.h"

namespace skinframe {
namespace {

using std::numbers::pi;
using testing::bare_problem;
using testing::chain;
using testing::Egg;
using testing::load_at;
using testing::make_egg;
using testing::pulled_chain;
using testing::top_load;

CertificateRequest request_for(const FrameProblem& problem) {
  CertificateRequest request;
  request.box = area_box(problem);
  for (std::size_t j = 0; j < request.box.lower_mm2.size(); ++j)
    request.start_mm2.push_back((request.box.lower_mm2[j] + request.box.upper_mm2[j]) / 2);
  return request;
}

// The largest force is gamma epsilon pi 25 / l.
TEST(InfeasibilityCertificate, OfAChainIsSharpAtTheLargestForceItCarries) {
  const double most = 1586 * 0.05 * pi * 25 / 90;
  for (double share : {1.0001, 1.1, 50.0}) {
    const FrameProblem problem = pulled_chain(share * most);
    const auto proven = certify_infeasible(problem, request_for(problem));
    ASSERT_TRUE(proven.has_value()) << share;
    EXPECT_EQ(proven->constraint, "displacement");
    EXPECT_GT(proven->value, 0);
    EXPECT_NEAR(proven->proven_ratio, share, 1e-5 * share) << "at the upper bound the chain comes no nearer";
    const DualValue again = dual_value(problem, proven->box, proven->proof);
    EXPECT_EQ(again.value, proven->value);
    EXPECT_EQ(again.normalisation, proven->normalisation);
  }
  for (double share : {0.01, 0.9, 0.9999}) {
    const FrameProblem problem = pulled_chain(share * most);
    EXPECT_FALSE(certify_infeasible(problem, request_for(problem)).has_value()) << share;
  }
}

// Heavier is not stiffer: a hanging strut that fails by its own weight fails at every area.
TEST(InfeasibilityCertificate, KnowsThatThickerStrutsAreHeavier) {
  FrameProblem problem = bare_problem({{0, 0, 400}, {0, 0, 200}, {0, 0, 0}}, {{0, 1}, {1, 2}});
  problem.fixed[0] = {true, true, true};
  problem.material.density_g_cm3 = 4e5;
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 2, {0, 0, 0}, true)};
  const auto proven = certify_infeasible(problem, request_for(problem));
  ASSERT_TRUE(proven.has_value());
  EXPECT_GT(proven->value, 0);
}

// Stress F / A > sigma at the upper bound, without a displacement limit.
TEST(InfeasibilityCertificate, OfStressWhereThereIsNoDisplacementLimit) {
  FrameProblem problem = chain(1, 50);
  problem.element = ElementModel::kAxial;
  problem.fixed[1] = {false, true, true};
  problem.material.tensile_strength_mpa = 5;
  problem.load_cases = {load_at(problem, 1, {5 * pi * 25 * 1.01, 0, 0})};
  const auto proven = certify_infeasible(problem, request_for(problem));
  ASSERT_TRUE(proven.has_value());
  EXPECT_EQ(proven->constraint, "stress");
  problem.load_cases = {load_at(problem, 1, {5 * pi * 25 * 0.99, 0, 0})};
  EXPECT_FALSE(certify_infeasible(problem, request_for(problem)).has_value());
}

// A massless skin: the centre of gravity lies on the struts, whose x is between 0 and 20; wanted beyond 25.
TEST(InfeasibilityCertificate, OfBalanceByOneEdge) {
  FrameProblem problem = bare_problem({{0, 0, 0}, {20, 0, 0}, {20, 0, 30}}, {{0, 1}, {1, 2}});
  problem.balance = {{{-1, 0}, -25}, {{1, 0}, 60}};
  const auto proven = certify_unbalanced(problem, request_for(problem));
  ASSERT_TRUE(proven.has_value());
  EXPECT_EQ(proven->constraint, "balance");
  EXPECT_GE(proven->value / proven->normalisation, 5 - 1e-9) << "at least 5 mm outside";
  problem.balance = {{{-1, 0}, -15}, {{1, 0}, 60}};
  EXPECT_FALSE(certify_unbalanced(problem, request_for(problem)).has_value());
}

// Neither edge alone is out of reach, but their corner is: x >= 12 needs the right strut, y >= 12 the left.
TEST(InfeasibilityCertificate, OfBalanceByTwoEdgesTogether) {
  FrameProblem problem = bare_problem({{20, 0, 0}, {20, 0, 30}, {0, 20, 0}, {0, 20, 30}}, {{0, 1}, {2, 3}});
  problem.balance = {{{-1, 0}, -12}, {{0, -1}, -12}};
  for (int only : {0, 1}) {
    FrameProblem one = problem;
    one.balance = {problem.balance[only]};
    EXPECT_FALSE(certify_unbalanced(one, request_for(one)).has_value());
  }
  const auto proven = certify_unbalanced(problem, request_for(problem));
  ASSERT_TRUE(proven.has_value());
  for (double multiplier : proven->proof.balance_multipliers) EXPECT_GT(multiplier, 0);
}

TEST(InfeasibilityCertificate, OfAFrameUnderAThousandNewton) {
  FrameProblem problem = make_egg(Egg{});
  problem.load_cases = {top_load(problem, "small", {0, 5, 0}), top_load(problem, "large", {0, 1000, 0})};
  const auto proven = certify_infeasible(problem, request_for(problem));
  ASSERT_TRUE(proven.has_value());
  ASSERT_EQ(proven->proof.fields.size(), 1u);
  EXPECT_EQ(proven->proof.fields[0].load_case, 1);
  problem.load_cases = {top_load(problem, "side", {0, 20, 0})};
  EXPECT_FALSE(certify_infeasible(problem, request_for(problem)).has_value());
}

// The proof is of the problem it was made for, and of no other.
TEST(InfeasibilityCertificate, ProvesNothingOfAProblemThatIsFeasible) {
  const double most = 1586 * 0.05 * pi * 25 / 90;
  const FrameProblem problem = pulled_chain(1.2 * most), easier = pulled_chain(0.99 * most);
  const auto proven = certify_infeasible(problem, request_for(problem));
  ASSERT_TRUE(proven.has_value());
  EXPECT_LE(dual_value(easier, proven->box, proven->proof).value, 0);
}

}  // namespace
}  // namespace skinframe
