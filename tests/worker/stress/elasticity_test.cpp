// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/elasticity.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <set>

#include "tests/worker/stress/tet_block.h"

namespace skinframe {
namespace {

constexpr ElasticMaterial kPa{1586, 0.35};

// A block whose inner vertices stand askew, so that no two tetrahedra are alike.
TetMesh askew_block() {
  TetMesh mesh = test::tet_block({4, 3, 5}, {8, 6, 10});
  std::set<int> outer;
  for (const auto& face : boundary_of(mesh)) outer.insert(face.begin(), face.end());
  std::mt19937_64 random(3);
  const auto jitter = [&] { return 0.4 * (static_cast<double>(random() % 1001) / 1000.0 - 0.5); };
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v)
    if (!outer.contains(static_cast<int>(v)))
      mesh.vertices_mm[v] += Eigen::Vector3d(jitter(), jitter(), jitter());
  return mesh;
}

ElasticResponse with_boundary_moved(const TetMesh& mesh, const Eigen::Matrix3d& gradient,
                                    const Eigen::Vector3d& shift) {
  Prescribed prescribed(mesh.vertices_mm.size());
  for (const auto& face : boundary_of(mesh))
    for (const int v : face) prescribed[v] = gradient * mesh.vertices_mm[v] + shift;
  const NodalVectors none(mesh.vertices_mm.size(), Eigen::Vector3d::Zero());
  auto solved = solve_elasticity(mesh, kPa, prescribed, {none}, RunContext{});
  EXPECT_TRUE(solved.ok()) << solved.error().message;
  return std::move(solved.value().front());
}

TEST(Elasticity, PatchTestGivesTheConstantStressEverywhere) {
  const TetMesh mesh = askew_block();
  Eigen::Matrix3d gradient;
  gradient << 1e-3, 2e-4, -3e-4, 5e-4, -7e-4, 1e-4, 0, 4e-4, 2e-3;
  const ElasticResponse response = with_boundary_moved(mesh, gradient, {0.1, -0.2, 0.3});
  const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double e = kPa.modulus_mpa, nu = kPa.poisson_ratio;
  const Eigen::Matrix3d s = e / (1 + nu) * strain +
                            e * nu / ((1 + nu) * (1 - 2 * nu)) * strain.trace() * Eigen::Matrix3d::Identity();
  const StressTensor expected{{s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)}};
  for (const StressTensor& stress : response.stress_mpa)
    EXPECT_LT((stress - expected).norm(), 1e-10 * expected.norm());
}

TEST(Elasticity, RigidMotionGivesNoStress) {
  const TetMesh mesh = askew_block();
  Eigen::Matrix3d spin;
  spin << 0, -1e-3, 2e-3, 1e-3, 0, -3e-3, -2e-3, 3e-3, 0;
  const ElasticResponse response = with_boundary_moved(mesh, spin, {1, 2, 3});
  for (const StressTensor& stress : response.stress_mpa) EXPECT_LT(von_mises_mpa(stress), 1e-9);
}

TEST(Elasticity, ReactionsAsideForcesDoTheWorkOfTheStrain) {  // Clapeyron: F.u = sum of V sigma.epsilon
  const TetMesh mesh = askew_block();
  Prescribed prescribed(mesh.vertices_mm.size());
  NodalVectors forces(mesh.vertices_mm.size(), Eigen::Vector3d::Zero());
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (mesh.vertices_mm[v].z() == 0.0) prescribed[v] = Eigen::Vector3d::Zero();
    if (mesh.vertices_mm[v].z() == 10.0) forces[v] = {0.3, -0.1, -1.0};
  }
  const auto solved = solve_elasticity(mesh, kPa, prescribed, {forces}, RunContext{});
  ASSERT_TRUE(solved.ok());
  double work = 0.0, energy = 0.0;
  for (std::size_t v = 0; v < forces.size(); ++v) work += forces[v].dot(solved->front().displacement_mm[v]);
  const double e = kPa.modulus_mpa, nu = kPa.poisson_ratio;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const StressTensor& s = solved->front().stress_mpa[t];
    const double trace = s[0] + s[1] + s[2];
    const double density =
        (1 + nu) / e * (s.head<3>().squaredNorm() + 2 * s.tail<3>().squaredNorm()) - nu / e * trace * trace;
    energy += tet_volume_mm3(mesh, mesh.tets[t]) * density;
  }
  EXPECT_NEAR(work, energy, 1e-9 * work);
}

TEST(Elasticity, CantileverBendsAsBeamTheorySays) {
  const double length = 60, side = 10, force = 5;
  const TetMesh mesh = test::tet_block({36, 6, 6}, {length, side, side});
  Prescribed prescribed(mesh.vertices_mm.size());
  NodalVectors forces(mesh.vertices_mm.size(), Eigen::Vector3d::Zero());
  std::vector<int> tip;
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (mesh.vertices_mm[v].x() == 0.0) prescribed[v] = Eigen::Vector3d::Zero();
    if (mesh.vertices_mm[v].x() == length) tip.push_back(static_cast<int>(v));
  }
  for (const int v : tip) forces[v].z() = -force / static_cast<double>(tip.size());
  const auto solved = solve_elasticity(mesh, kPa, prescribed, {forces}, RunContext{});
  ASSERT_TRUE(solved.ok());
  double sag = 0.0;
  for (const int v : tip) sag -= solved->front().displacement_mm[v].z() / static_cast<double>(tip.size());
  const double inertia = side * side * side * side / 12;
  const double shear = kPa.modulus_mpa / (2 * (1 + kPa.poisson_ratio));
  const double beam = force * length * length * length / (3 * kPa.modulus_mpa * inertia) +
                      force * length / (shear * side * side * 5 / 6);
  EXPECT_LT(sag, beam);         // constant strain is too stiff,
  EXPECT_GT(sag, 0.85 * beam);  // by a seventh with six elements across
}

TEST(Elasticity, WhatIsNotHeldIsRefused) {
  const TetMesh mesh = test::tet_block({2, 2, 2}, {2, 2, 2});
  NodalVectors forces(mesh.vertices_mm.size(), Eigen::Vector3d::UnitZ());
  const auto solved =
      solve_elasticity(mesh, kPa, Prescribed(mesh.vertices_mm.size()), {forces}, RunContext{});
  ASSERT_FALSE(solved.ok());
  EXPECT_EQ(solved.error().kind, ErrorKind::kInvalidInput);
}

}  // namespace
}  // namespace skinframe
