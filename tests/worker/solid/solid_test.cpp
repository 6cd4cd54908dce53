// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/solid.h"

#include <gmock/gmock.h>

#include <map>
#include <tuple>

#include "tests/worker/solid/shapes.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;
using namespace testing;

TEST(Solid, MeasuresOfACube) {
  const Result<Solid> solid = Solid::make(moved(cube(20), {1, 2, 3}));
  ASSERT_TRUE(solid.ok()) << solid.error().message;
  EXPECT_NEAR(solid->volume_mm3(), 8000, 1e-9);
  EXPECT_NEAR(solid->area_mm2(), 2400, 1e-9);
  EXPECT_NEAR((solid->centroid_mm() - Eigen::Vector3d(11, 12, 13)).norm(), 0, 1e-12);
  EXPECT_EQ(solid->box().min, Eigen::Vector3d(1, 2, 3));
}

TEST(Solid, ASmoothBodyComesCloseToItsFormula) {
  const Result<Solid> solid = Solid::make(ball(50, 128, 64));
  ASSERT_TRUE(solid.ok()) << solid.error().message;
  EXPECT_NEAR(solid->volume_mm3() / (4.0 / 3 * std::numbers::pi * 125'000), 1, 3e-3);
}

TEST(Solid, EveryDirectedEdgeStandsOnceAndItsReverseOnce) {
  const Result<Solid> solid = Solid::make(torus(40, 12, 30, 14));
  ASSERT_TRUE(solid.ok()) << solid.error().message;
  std::map<std::pair<int, int>, int> uses;
  for (const auto& t : solid->mesh().triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(uses.count({edge.second, edge.first}), 1u);
  }
}

TEST(Solid, EveryCoordinateIsAFloatAndNoTwoVerticesCoincide) {
  const Result<Solid> solid = Solid::make(ball(33.3, 40, 20));
  ASSERT_TRUE(solid.ok()) << solid.error().message;
  std::map<std::tuple<double, double, double>, int> places;
  for (const auto& v : solid->mesh().vertices) {
    for (const double x : v) EXPECT_EQ(x, static_cast<double>(static_cast<float>(x)));
    EXPECT_EQ(++places[std::make_tuple(v.x(), v.y(), v.z())], 1);
  }
}

TEST(Solid, WhatRoundingPressesFlatIsTakenOutAndTheRestStaysClosed) {
  // A cube whose one corner is a spike of four triangles a thousandth of a float step wide.
  TriangleMesh mesh = moved(cube(20), {1000, 1000, 1000});
  const int middle = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(mesh.vertices[0] + Eigen::Vector3d(1e-8, 2e-8, 0));
  const auto t = mesh.triangles[0];
  mesh.triangles[0] = {t[0], t[1], middle};
  mesh.triangles.push_back({t[1], t[2], middle});
  mesh.triangles.push_back({t[2], t[0], middle});
  const Result<Solid> solid = Solid::make(mesh);
  ASSERT_TRUE(solid.ok()) << solid.error().message;
  EXPECT_EQ(solid->mesh().triangles.size(), 12u);
  EXPECT_NEAR(solid->volume_mm3(), 8000, 1e-6);
}

TEST(Solid, CannotBeMadeOpenInsideOutEmptyOrFlat) {
  TriangleMesh open = cube(20);
  open.triangles.pop_back();
  TriangleMesh one_turned = cube(20);
  std::swap(one_turned.triangles[4][1], one_turned.triangles[4][2]);
  const TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  TriangleMesh wild = cube(20);
  wild.triangles[3][1] = 8;
  TriangleMesh infinite = cube(20);
  infinite.vertices[3].y() = std::numeric_limits<double>::infinity();
  const auto message = [](TriangleMesh mesh) {
    const Result<Solid> solid = Solid::make(std::move(mesh));
    return solid.ok() ? "no error" : solid.error().message;
  };
  EXPECT_THAT(message(open), HasSubstr("has 1 triangle"));
  EXPECT_THAT(message(one_turned), HasSubstr("look opposite ways"));
  EXPECT_THAT(message(turned_inside_out(cube(20))), HasSubstr("encloses no volume"));
  EXPECT_THAT(message({}), HasSubstr("encloses no volume"));
  EXPECT_THAT(message(flat), HasSubstr("encloses no volume"));
  EXPECT_THAT(message(wild), HasSubstr("triangle 3: index 8 of 8"));
  EXPECT_THAT(message(infinite), HasSubstr("vertex 3"));
}

}  // namespace
}  // namespace skinframe
