// SPDX-License-Identifier: GPL-3.0-or-later
// The stages of a verification on bodies whose answer is known: a box-like tower, a sphere.
#include "worker/verify/verify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/worker/fixture/geodesic_sphere.h"
#include "tests/worker/fixture/skin_of.h"
#include "worker/skin/triangle_tree.h"
#include "worker/verify/assess.h"
#include "worker/verify/hollow.h"
#include "worker/verify/relax_skin.h"
#include "worker/verify/shell_models.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;
constexpr double kRadiusMm = 20;

TriangleMesh ball(double radius_mm, int frequency) {
  Frame frame;
  test::add_geodesic_triangles(frequency, frame);
  TriangleMesh mesh{frame.nodes_mm, frame.skin_triangles};
  for (Vector3d& p : mesh.vertices) p = p * radius_mm + Vector3d(0, 0, kRadiusMm);
  return mesh;
}

// A ball of 40 mm, a frame of 162 skin nodes below 1 mm of skin, one spoke from pole to pole through the
// middle.
class Ball : public testing::Test {
 protected:
  Ball() : body_(ball(kRadiusMm, 24)), skin_(test::skin_of(body_)) {
    Frame& frame = problem_.frame;
    const TriangleMesh inner = ball(kRadiusMm - 1, 4);
    frame.nodes_mm = inner.vertices;
    frame.skin_triangles = inner.triangles;
    frame.skin_node_count = static_cast<int>(inner.vertices.size());
    for (const auto& t : inner.triangles)
      for (int k = 0; k < 3; ++k)
        if (t[k] < t[(k + 1) % 3]) frame.struts.push_back({t[k], t[(k + 1) % 3], true});
    frame.nodes_mm.push_back({0, 0, kRadiusMm});
    const int middle = frame.skin_node_count;
    int low = 0, high = 0;
    for (int i = 0; i < middle; ++i) {
      if (frame.nodes_mm[i].z() < frame.nodes_mm[low].z()) low = i;
      if (frame.nodes_mm[i].z() > frame.nodes_mm[high].z()) high = i;
    }
    frame.struts.push_back({low, middle, false});
    frame.struts.push_back({middle, high, false});
    problem_.material = {"pa", 1586, 1387, 43, 48, 60, 1.15};
    for (const Vector3d& p : frame.nodes_mm) {
      const bool foot = p.z() < 4;
      problem_.fixed.push_back({false, false, foot});
    }
    radii_.assign(frame.struts.size(), 0.5);
  }

  VerifyInput input() {
    VerifyInput in{.problem = problem_,
                   .radii_mm = radii_,
                   .skin = skin_,
                   .body = body_,
                   .solid_volume_mm3 = 4.0 / 3 * pi * std::pow(kRadiusMm, 3),
                   .printed_volume_mm3 = 0,
                   .place_loads = {},
                   .loads = {{"down", {0, 0, 2 * kRadiusMm}, {0, 0, -5}, 5}}};
    in.printed_volume_mm3 = in.solid_volume_mm3 * 0.2;
    in.place_loads = [](const Frame& frame) -> Result<std::vector<LoadCase>> {
      std::vector<Vector3d> none(frame.nodes_mm.size(), Vector3d::Zero()), down = none;
      double area = 0;
      for (std::size_t i = 0; i < down.size(); ++i) area += frame.nodes_mm[i].z() > 2 * kRadiusMm - 2 ? 1 : 0;
      for (std::size_t i = 0; i < down.size(); ++i)
        if (frame.nodes_mm[i].z() > 2 * kRadiusMm - 2) down[i].z() = -5 / area;
      return std::vector<LoadCase>{{"self-weight", true, none}, {"down", true, down}};
    };
    return in;
  }

  TriangleMesh body_;
  Skin skin_;
  FrameProblem problem_;
  std::vector<double> radii_;
};

TEST_F(Ball, FineSkinStandsOnM1AndKeepsTheFramesNodesAndStruts) {
  const FineSkin fine = refine_skin(problem_.frame, skin_, 2);
  EXPECT_EQ(fine.frame.skin_triangles.size(), 16 * problem_.frame.skin_triangles.size());
  for (std::size_t i = 0; i < fine.frame.nodes_mm.size(); ++i) {
    const Vector3d out = fine.frame.nodes_mm[i] - Vector3d(0, 0, kRadiusMm);
    EXPECT_NEAR(out.norm(), kRadiusMm - 1, 0.08);
    EXPECT_GT(fine.normals[i].dot(out.normalized()), 0.99);
  }
  for (std::size_t j = 0; j < problem_.frame.struts.size(); ++j) {
    const Strut& strut = problem_.frame.struts[j];
    ASSERT_EQ(fine.chains[j].size(), strut.is_skin ? 5u : 0u);
    if (!strut.is_skin) continue;
    EXPECT_EQ(fine.chains[j].front(), strut.a);
    EXPECT_EQ(fine.chains[j].back(), strut.b);
  }
}

// Of each mesh: the cap of the sphere below the height, with angles as good as those of halved triangles.
TEST_F(Ball, ContactEndsAtItsHeightWhateverTheMesh) {
  const double height = contact_height_mm(problem_).value(), inner = kRadiusMm - 1;
  EXPECT_NEAR(height, 3.9, 0.1);  // of the frame's highest node below 4 mm
  const double cap = 2 * pi * inner * (height - 1);
  for (const int levels : {0, 1, 2}) {
    const FineSkin fine = refine_skin(problem_.frame, skin_, levels, height);
    const auto& nodes = fine.frame.nodes_mm;
    double held = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (fine.in_contact[i]) {
        EXPECT_LT(nodes[i].z(), height + 0.02);
      }
    }
    for (const auto& t : fine.frame.skin_triangles) {
      const Vector3d a = nodes[t[1]] - nodes[t[0]], b = nodes[t[2]] - nodes[t[0]], c = b - a;
      const double area = a.cross(b).norm() / 2;
      EXPECT_GT(4 * std::sqrt(3.0) * area / (a.squaredNorm() + b.squaredNorm() + c.squaredNorm()), 0.3);
      if (fine.in_contact[t[0]] && fine.in_contact[t[1]] && fine.in_contact[t[2]]) held += area;
    }
    EXPECT_NEAR(held / cap, 1, 0.04) << levels;
    for (std::size_t j = 0; j < problem_.frame.struts.size(); ++j) {
      const auto& chain = fine.chains[j];
      for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
        const double share = (nodes[chain[k + 1]] - nodes[chain[k]]).norm() * (1 << levels) /
                             problem_.frame.length_mm(problem_.frame.struts[j]);
        EXPECT_LT(share, 1.5);  // no part of a strut leaves its neighbours' middles out
      }
    }
  }
}

// As single nodes they would: there is no limit to how far a shell gives way below a point.
TEST_F(Ball, SupportsDoNotGiveWayTheMoreTheFinerTheMeshIs) {
  RunContext context;
  std::vector<double> works;
  for (const int levels : {1, 2, 3}) {
    const FineSkin fine = refine_skin(problem_.frame, skin_, levels, contact_height_mm(problem_));
    const Structure s = skin_frame_structure(problem_, radii_, skin_, fine);
    const auto solver = StructureSolver::factorise(s, context);
    ASSERT_TRUE(solver.ok()) << solver.error().message;
    works.push_back(load_works(*solver, {{"self-weight", true, {}}}).at(0));
  }
  EXPECT_NEAR(works[1] / works[2], 1, 0.02);
  EXPECT_NEAR(works[0] / works[2], 1, 0.06);
}

TEST_F(Ball, FoldsAreMendedOverM1) {
  FineSkin fine = refine_skin(problem_.frame, skin_, 1);
  Frame frame = fine.frame;
  const int first = problem_.frame.skin_node_count;
  for (int i = first; i < static_cast<int>(frame.nodes_mm.size()); i += 20) {
    // Over its neighbours, or off the sphere.
    const Vector3d out = frame.nodes_mm[i] - Vector3d(0, 0, kRadiusMm);
    if (i % 40 < 20)
      frame.nodes_mm[i] += 1.3 * kRadiusMm / 4 * out.unitOrthogonal();
    else
      frame.nodes_mm[i] -= 0.15 * out;
  }
  const auto least_cosine = [](const Frame& f) {
    double least = 1;
    for (const auto& t : f.skin_triangles) {
      const Vector3d &a = f.nodes_mm[t[0]], &b = f.nodes_mm[t[1]], &c = f.nodes_mm[t[2]];
      const Vector3d out = (a + b + c) / 3 - Vector3d(0, 0, kRadiusMm);
      least = std::min(least, (b - a).cross(c - a).normalized().dot(out.normalized()));
    }
    return least;
  };
  ASSERT_LT(least_cosine(frame), -0.5);
  relax_skin(skin_, first, &frame);
  EXPECT_GT(least_cosine(frame), 0.8);
  for (int i = 0; i < static_cast<int>(frame.nodes_mm.size()); ++i) {
    EXPECT_NEAR((frame.nodes_mm[i] - Vector3d(0, 0, kRadiusMm)).norm(), kRadiusMm - 1, 0.2);
    if (i < first) {
      EXPECT_EQ(frame.nodes_mm[i], problem_.frame.nodes_mm[i]);
    }
  }
}

TEST_F(Ball, StructureWeighsTheSkinAndItsStrutsHalvedInTheSkin) {
  const FineSkin fine = refine_skin(problem_.frame, skin_, 2);
  const Structure s = skin_frame_structure(problem_, radii_, skin_, fine);
  ASSERT_TRUE(validate(s).ok());
  const double middle = kRadiusMm - 0.5, shell = 4 * pi * middle * middle;
  double struts = 0;
  for (const Strut& strut : problem_.frame.struts)
    struts += pi * 0.25 * problem_.frame.length_mm(strut) * (strut.is_skin ? 0.5 : 1);
  EXPECT_NEAR(structure_volume_mm3(s) / (shell + struts), 1, 0.015);
  int halves = 0;
  for (const StructureStrut& strut : s.struts) halves += strut.shape == StrutShape::kFullDisc;
  EXPECT_EQ(halves, 4);  // two internal struts in two parts each
}

TEST_F(Ball, WallOfEqualVolumeIsThatOfTheHollowBall) {
  const double solid = 4.0 / 3 * pi * std::pow(kRadiusMm, 3);
  for (const double wall : {1.0, 2.5, 6.0}) {
    const double volume = solid - 4.0 / 3 * pi * std::pow(kRadiusMm - wall, 3);
    EXPECT_NEAR(equal_volume_wall_mm(skin_, solid, volume), wall, 0.03 + 0.01 * wall);
  }
}

TEST_F(Ball, TwoWallsThatMeetAreNoThickerThanTheBody) {
  const FineSkin fine = refine_skin(problem_.frame, skin_, 1);
  const TriangleTree tree(body_);
  for (const double wall : local_walls_mm(fine, skin_, tree, 50)) EXPECT_NEAR(wall, kRadiusMm, 0.7);
  for (const double wall : local_walls_mm(fine, skin_, tree, 2)) EXPECT_NEAR(wall, 2, 1e-9);
}

TEST_F(Ball, PinchesAreSpreadAntipodalAndInBalance) {
  const FineSkin fine = refine_skin(problem_.frame, skin_, 2);
  const TriangleTree tree(body_);
  const auto sites = spread_pinches(fine, skin_, tree);
  ASSERT_EQ(sites.size(), kPinchSites);
  const Structure s = skin_alone_structure(problem_, skin_, fine);
  const NodalColumns f = pinch_columns(s, fine, sites);
  for (std::size_t c = 0; c < sites.size(); ++c) {
    EXPECT_GT(sites[c].apart_mm, 2 * kRadiusMm - 6);
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    double size = 0;
    for (std::size_t i = 0; i < s.nodes_mm.size(); ++i) {
      const Vector3d push = f.col(c).segment<3>(6 * i);
      force += push;
      moment += s.nodes_mm[i].cross(push);
      size += push.norm();
    }
    EXPECT_NEAR(size, 2 * kPinchForceN, 1e-9);
    EXPECT_LT(force.norm(), 1e-12);
    EXPECT_LT(moment.norm(), 1e-9);
  }
}

// Reissner's shallow sphere under a point load: w = sqrt(3 (1 - nu^2)) / 4 * F R / (E t^2), at each pole of a
// pinch. Fingers of 10 mm on a 40 mm ball are no points: the patch gives way less, by a known order.
TEST_F(Ball, PinchedShellClosesAsAThinSphereDoes) {
  const FineSkin fine = refine_skin(problem_.frame, skin_, 3);
  const TriangleTree tree(body_);
  RunContext context;
  const auto sites = spread_pinches(fine, skin_, tree, 6);
  auto in = input();
  const auto cases = in.place_loads(fine.frame);
  const auto alone = assess(skin_alone_structure(problem_, skin_, fine), fine, cases.value(), sites, context);
  ASSERT_TRUE(alone.ok()) << alone.error().message;
  const double point = std::sqrt(3 * (1 - kPoissonRatio * kPoissonRatio)) / 4 * kPinchForceN *
                       (kRadiusMm - 0.5) / (1586 * 1.0);
  EXPECT_LT(alone->figures.pinch->mean_mm, 2 * point);
  EXPECT_GT(alone->figures.pinch->mean_mm, 0.35 * 2 * point);
}

TEST_F(Ball, VerificationHoldsTogether) {
  RunContext context;
  const auto v = verify(input(), context);
  ASSERT_TRUE(v.ok()) << v.error().message;
  EXPECT_LT(v->balance_force, kBalanceTolerance);
  EXPECT_LT(v->balance_moment, kBalanceTolerance);
  EXPECT_GE(v->levels, 2);
  EXPECT_TRUE(v->mesh_error < kMeshTolerance ||
              fine_node_count(problem_.frame, v->levels + 1) > kMostFineNodes);
  ASSERT_EQ(v->deformations.size(), 2u);
  double most = 0;
  for (const Deformation& deformation : v->deformations)
    for (const Vector3d& d : deformation.displacement_mm) most = std::max(most, d.norm());
  EXPECT_DOUBLE_EQ(most, v->ours.max_displacement_mm());
  EXPECT_DOUBLE_EQ(*v->safety_factor, 43 / v->ours.max_stress_mpa());
  ASSERT_TRUE(v->hollow && v->skin_alone && v->solid) << v->hollow_missing << v->solid_missing;
  // A spoke and ribs are stiffer than the skin alone; the solid is stiffer than all.
  EXPECT_LT(v->ours.max_displacement_mm(), v->skin_alone->max_displacement_mm());
  EXPECT_LT(v->ours.pinch->max_mm, v->skin_alone->pinch->max_mm);
  EXPECT_LT(v->solid->pinch->mean_mm, v->ours.pinch->mean_mm);
  EXPECT_LT(v->solid->pinch->mean_mm, v->hollow->pinch->mean_mm);
  EXPECT_NEAR(v->hollow->weight_g, v->ours.weight_g, 1e-9);
  EXPECT_GT(*v->ours.buckling_factor(), 1);
  EXPECT_GT(v->euler_factor.value(), 1);
  EXPECT_EQ(v->verdict, verdict_of(*v));
}

TEST_F(Ball, WhatNothingHoldsIsNotVerified) {
  for (auto& fixed : problem_.fixed) fixed = {false, false, false};
  RunContext context;
  const auto v = verify(input(), context);
  ASSERT_FALSE(v.ok());
  EXPECT_THAT(v.error().message, testing::HasSubstr("not held"));
}

}  // namespace
}  // namespace skinframe
