// SPDX-License-Identifier: GPL-3.0-or-later
// The solid on a foot that is small beside its tetrahedra: a ball on a stem.
#include "worker/verify/solid_reference.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/worker/fixture/skin_of.h"
#include "worker/frame/on_m1.h"
#include "worker/solid/contact.h"
#include "worker/stress/lattice.h"
#include "worker/stress/quadratic_solid.h"
#include "worker/structure/solve_structure.h"
#include "worker/verify/foot.h"
#include "worker/verify/shell_models.h"

namespace skinframe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;
constexpr double kBallMm = 20, kStemHighMm = 4;
const ElasticMaterial kPa{1586, kPoissonRatio};

double centre_z(double stem_mm) { return kStemHighMm + std::sqrt(kBallMm * kBallMm - stem_mm * stem_mm); }

// A ball on a stem of a given radius, its foot at z = 0: radius and height along the outline, turned.
TriangleMesh ball_on_a_stem(double stem_mm, int around, int along) {
  std::vector<Vector2d> outline;
  const int across = std::max(2, along / 12), up = std::max(2, along / 8);
  for (int i = 1; i < across; ++i) outline.emplace_back(stem_mm * i / across, 0);
  for (int i = 0; i < up; ++i) outline.emplace_back(stem_mm, kStemHighMm * i / up);
  const double low = std::acos(-std::sqrt(1 - std::pow(stem_mm / kBallMm, 2)));
  for (int i = 0; i < along; ++i) {
    const double angle = low * (along - i) / along;
    outline.emplace_back(kBallMm * std::sin(angle), centre_z(stem_mm) + kBallMm * std::cos(angle));
  }
  TriangleMesh mesh;
  for (const Vector2d& p : outline)
    for (int k = 0; k < around; ++k)
      mesh.vertices.emplace_back(p.x() * std::cos(2 * pi * k / around), p.x() * std::sin(2 * pi * k / around),
                                 p.y());
  const int rings = static_cast<int>(outline.size()), foot = rings * around, top = foot + 1;
  mesh.vertices.emplace_back(0, 0, 0);
  mesh.vertices.emplace_back(0, 0, centre_z(stem_mm) + kBallMm);
  for (int k = 0; k < around; ++k) {
    const int next = (k + 1) % around;
    mesh.triangles.push_back({foot, next, k});
    for (int i = 0; i + 1 < rings; ++i) {
      const int a = i * around + k, b = i * around + next;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
    mesh.triangles.push_back({(rings - 1) * around + k, (rings - 1) * around + next, top});
  }
  return mesh;
}

std::vector<SolidCase> pushes(double stem_mm) {
  const Vector3d top(0, 0, centre_z(stem_mm) + kBallMm);
  return {{"side", false, {{"side", top, {1, 0, 0}, 5}}}, {"down", false, {{"down", top, {0, 0, -1}, 5}}}};
}

// Work of the loads, on tetrahedra of a spacing away from the foot.
std::vector<double> work_of(const StandingSolid& solid, double stem_mm) {
  RunContext context;
  const auto answers = solve_quadratic_solid(
      solid.mesh, kPa, 0, [&](const Vector3d& p) { return p.z() <= solid.held_below_mm; }, pushes(stem_mm),
      context);
  EXPECT_TRUE(answers.ok()) << answers.error().message;
  return {answers->at(0).external_work_n_mm, answers->at(1).external_work_n_mm};
}

StandingSolid stand(const Skin& skin, const TriangleMesh& body, const SolidSpacing& spacing) {
  RunContext context;
  auto solid = standing_solid(skin, body, kContactToleranceMm, spacing, context);
  EXPECT_TRUE(solid.ok()) << solid.error().message;
  return std::move(solid).value();
}

TEST(Foot, OfABallOnAStemIsADiscWithItsLowestWall) {
  const Foot foot = foot_of(ball_on_a_stem(3, 96, 48), kContactToleranceMm);
  EXPECT_NEAR(foot.area_mm2 / (pi * 9 + 2 * pi * 3 * kContactToleranceMm), 1, 0.01);
  EXPECT_NEAR(foot.width_mm, 3, 0.03);
}

TEST(Foot, OfWhatLiesBelowAltogetherHasNoRim) {
  const TriangleMesh body = ball_on_a_stem(3, 12, 12);
  EXPECT_TRUE(std::isinf(foot_of(body, 100).width_mm));
  EXPECT_EQ(foot_of(body, -1).area_mm2, 0);
}

TEST(SolidReference, AStemBendsAndTheBallRocksOnItAsTheyShould) {
  const double stem = 2;
  const TriangleMesh body = ball_on_a_stem(stem, 96, 64);
  const Skin skin = test::skin_of(body);
  // As a result's: cells to make 8000 tetrahedra. The stem is as wide as one of them.
  const double spacing = std::cbrt(kTetsACell * 4.0 / 3 * pi * std::pow(kBallMm, 3) / kSolidTetrahedra);
  EXPECT_GT(spacing, 1.8 * stem);
  const StandingSolid solid = stand(skin, body, {.body_mm = spacing});
  EXPECT_LT(solid.mesh.tets.size(), kMostSolidTetrahedra);
  const double held = area_held_mm2(solid.mesh, solid.held_below_mm);
  RecordProperty("held", std::to_string(held / solid.foot_area_mm2));
  EXPECT_GE(held, solid.foot_area_mm2);
  EXPECT_LT(held, 1.3 * solid.foot_area_mm2);

  // The stem bends, and rocks the half space above it as a glued disc does. Held is its lowest millimetre. So
  // short a stem is a beam to a tenth.
  const double g = kPa.modulus_mpa / (2 * (1 + kPoissonRatio)), nu = kPoissonRatio;
  const double high = centre_z(stem) + kBallMm, from = kContactToleranceMm, to = kStemHighMm;
  const double inertia = pi * std::pow(stem, 4) / 4;
  const double bent = (std::pow(high - from, 3) - std::pow(high - to, 3)) / (3 * kPa.modulus_mpa * inertia);
  const double rocked = std::pow(high - to, 2) * 3 * (1 - nu) / (8 * g * std::pow(stem, 3));
  const auto work = work_of(solid, stem);
  RecordProperty("side", std::to_string(work[0] / (bent + rocked)));
  EXPECT_NEAR(work[0] / (bent + rocked), 1, 0.15);

  const auto finer = work_of(stand(skin, body, {spacing / 1.2, 3, kMaxQuadraticTets}), stem);
  RecordProperty("side_finer", std::to_string(work[0] / finer[0]));
  RecordProperty("down_finer", std::to_string(work[1] / finer[1]));
  EXPECT_NEAR(work[0] / finer[0], 1, 0.03);
  EXPECT_NEAR(work[1] / finer[1], 1, 0.03);

  // What this is for: the same tetrahedra all through know nothing of such a foot.
  RunContext context;
  const auto plain = fill_with_tetrahedra([&](const Vector3d& p) { return skin.field.at(p); },
                                          skin.body_box_mm, spacing, context);
  ASSERT_TRUE(plain.ok());
  const auto turns = solve_quadratic_solid(
      *plain, kPa, 0, [](const Vector3d& p) { return p.z() <= kContactToleranceMm; }, pushes(stem), context);
  RecordProperty("plain", turns.ok() ? std::to_string(turns->front().external_work_n_mm / work[0]) : "none");
  EXPECT_FALSE(turns.ok() && std::abs(turns->front().external_work_n_mm / work[0] - 1) < 0.1);
}

TEST(SolidReference, IsNeverSofterThanTheHollowOfTheSameBody) {
  const double stem = 4, wall = 1;
  const TriangleMesh body = ball_on_a_stem(stem, 96, 64);
  const Skin skin = test::skin_of(body);
  FrameProblem problem;
  problem.material = {"pa", 1586, 1387, 43, 48, 60, 1.15};
  const TriangleMesh coarse = ball_on_a_stem(stem, 16, 16);
  for (const Vector3d& p : coarse.vertices) problem.frame.nodes_mm.push_back(onto_m1(p, skin));
  problem.frame.skin_triangles = coarse.triangles;
  problem.frame.skin_node_count = static_cast<int>(coarse.vertices.size());
  problem.fixed.assign(problem.frame.nodes_mm.size(), {false, false, false});
  const FineSkin fine = refine_skin(problem.frame, skin, 1);
  Structure shell =
      hollow_structure(problem, skin, fine, std::vector<double>(fine.frame.nodes_mm.size(), wall));
  for (std::size_t i = 0; i < shell.nodes_mm.size(); ++i)
    if (shell.nodes_mm[i].z() <= kContactToleranceMm + 0.2) shell.held[i] = kClamped;
  NodalColumns loads = NodalColumns::Zero(6 * static_cast<Eigen::Index>(shell.nodes_mm.size()), 2);
  const Eigen::Index top = static_cast<Eigen::Index>(coarse.vertices.size()) - 1;
  loads(6 * top, 0) = 1;
  loads(6 * top + 2, 1) = -1;
  RunContext context;
  const auto solver = StructureSolver::factorise(shell, context);
  ASSERT_TRUE(solver.ok()) << solver.error().message;
  const NodalColumns d = solver->solve(loads);
  const auto solid = work_of(stand(skin, body, {.body_mm = 3}), stem);
  for (int c = 0; c < 2; ++c) {
    RecordProperty(c == 0 ? "side" : "down", std::to_string(solid[c] / loads.col(c).dot(d.col(c))));
    EXPECT_LT(solid[c], loads.col(c).dot(d.col(c)));
  }
}

}  // namespace
}  // namespace skinframe
