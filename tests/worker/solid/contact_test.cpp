// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/contact.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/worker/solid/shapes.h"

namespace skinframe {
namespace {

using namespace testing;

Contact contact_of(const TriangleMesh& mesh) {
  const Result<Solid> solid = Solid::make(mesh);
  EXPECT_TRUE(solid.ok()) << solid.error().message;
  return find_contact(solid.value());
}

double area_of(const Polygon2& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;  // positive when counter-clockwise
}

TEST(Contact, ACubeStandsOnItsWholeSide) {
  const Contact contact = contact_of(moved(cube(20), {0, 0, 7}));
  EXPECT_TRUE(contact.stands);
  EXPECT_NEAR(contact.margin_mm, 10, 1e-12);
  EXPECT_EQ(contact.plane_z_mm, 7);
  ASSERT_EQ(contact.hull.size(), 4u);
  EXPECT_NEAR(area_of(contact.hull), 400, 1e-9);
}

// A ball's cap of height t has the radius sqrt(2 R t - t^2): the triangles are clipped, not taken whole.
TEST(Contact, ABallTouchesWithItsCapOnly) {
  const Contact contact = contact_of(ball(50, 200, 100));
  const double radius = std::sqrt(2 * 50 * kContactToleranceMm - 1);
  EXPECT_TRUE(contact.stands);
  EXPECT_NEAR(contact.margin_mm, radius, 0.05);
  EXPECT_NEAR(area_of(contact.hull), std::numbers::pi * radius * radius, 3);
}

TEST(Contact, ALargeTriangleCountsWithItsLowPartOnly) {
  // A wedge 100 mm long that rises by 10 mm: only its first tenth is within a millimetre.
  TriangleMesh wedge = box({0, 0, 0}, {100, 30, 20});
  for (auto& v : wedge.vertices) {
    if (v.z() == 0 && v.x() == 100) v.z() = 10;
  }
  const Polygon2 hull = contact_hull(wedge);
  EXPECT_NEAR(area_of(hull), 10 * 30, 1e-9);
  EXPECT_FALSE(contact_of(wedge).stands);
  EXPECT_LT(contact_of(wedge).margin_mm, -30);
}

TEST(Contact, AnOverhangBeyondTheFootFalls) {
  // Foot 20 x 20 x 20 and a beam on it that reaches 80 mm to one side; they cross, which a solid may.
  const TriangleMesh lamp = merged(cube(20), box({0, 0, 19}, {100, 20, 39}));
  const Contact contact = contact_of(lamp);
  EXPECT_FALSE(contact.stands);
  EXPECT_NEAR(contact.margin_mm, -((8000 * 10 + 40000 * 50) / 48000.0 - 20), 1e-6);
}

TEST(Contact, HullsAreCounterClockwiseWithoutPointsInLine) {
  const Polygon2 hull = convex_hull({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 1}, {0, 0}});
  EXPECT_EQ(hull.size(), 4u);
  EXPECT_NEAR(area_of(hull), 4, 1e-15);
  EXPECT_TRUE(convex_hull({}).empty());
  EXPECT_EQ(convex_hull({{1, 1}, {1, 1}}).size(), 1u);
  EXPECT_EQ(convex_hull({{0, 0}, {1, 1}, {2, 2}}).size(), 2u);
}

TEST(Contact, TheMarginIsTheDistanceToTheBoundary) {
  const Polygon2 square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_NEAR(signed_margin_mm(square, {1, 2}), 1, 1e-15);
  EXPECT_NEAR(signed_margin_mm(square, {-3, -4}), -5, 1e-15);
  EXPECT_NEAR(signed_margin_mm(square, {2, 6}), -2, 1e-15);
  EXPECT_NEAR(signed_margin_mm({{0, 0}, {4, 0}}, {2, 1}), -1, 1e-15);
  EXPECT_LT(signed_margin_mm({}, {0, 0}), 0);
}

TEST(Contact, APointOrEdgeIsNoStand) {
  TriangleMesh edge = box({-10, -10, 0}, {10, 10, 20});
  for (auto& v : edge.vertices) v = Eigen::Vector3d(v.x() - v.z(), v.y(), v.x() + v.z());
  const Polygon2 hull = contact_hull(edge, 0);
  EXPECT_EQ(hull.size(), 2u);
}

TEST(InscribedPolygon, KeepsItsCornersAndLosesLessThanAHundredthOfACircle) {
  Polygon2 circle;
  for (int i = 0; i < 300; ++i)
    circle.emplace_back(std::cos(2 * M_PI * i / 300), std::sin(2 * M_PI * i / 300));
  const Polygon2 few = inscribed_polygon(circle, 24);
  ASSERT_EQ(few.size(), 24u);
  for (const auto& corner : few) EXPECT_NE(std::find(circle.begin(), circle.end(), corner), circle.end());
  EXPECT_GT(signed_margin_mm(few, {0, 0}), 0.97);
  EXPECT_LE(signed_margin_mm(few, {0, 0}), 1.0);
}

TEST(InscribedPolygon, LeavesAPolygonOfFewCornersAlone) {
  const Polygon2 square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  EXPECT_EQ(inscribed_polygon(square, 24), square);
}

}  // namespace
}  // namespace skinframe
