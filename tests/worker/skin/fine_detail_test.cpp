// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/fine_detail.h"

#include <gtest/gtest.h>

#include "tests/worker/skin/bodies.h"
#include "worker/skin/build_skin.h"
#include "worker/skin/taubin.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {

// Bumps of 2 * height, some `wave` mm apart, on a sphere that touches z = 0.
TriangleMesh bumpy_sphere(double radius, double height, double wave) {
  TriangleMesh mesh = bodies::sphere(radius, 5);
  const Eigen::Vector3d centre(0, 0, radius);
  const double k = 2 * std::numbers::pi / wave;
  for (auto& v : mesh.vertices) {
    const Eigen::Vector3d out = (v - centre).normalized();
    v += height * std::sin(k * v.x()) * std::sin(k * v.y()) * std::cos(k * v.z()) * out;
  }
  return bodies::as_stored(mesh);
}

Skin skin_of(const TriangleMesh& body, Smooth smooth) {
  RunContext context;
  SkinOptions options;
  options.smooth = smooth;
  auto skin = build_skin(body, options, context);
  EXPECT_TRUE(skin.ok()) << skin.error().message;
  return std::move(skin.value());
}

TEST(Taubin, KeepsASphereAndTakesItsBumps) {
  const auto spread = [](const TriangleMesh& mesh) {
    double low = 1e9, high = 0;
    for (const auto& v : mesh.vertices) {
      const double r = (v - Eigen::Vector3d(0, 0, 10)).norm();
      low = std::min(low, r);
      high = std::max(high, r);
    }
    return high - low;
  };
  TriangleMesh plain = bodies::sphere(10, 5), bumpy = bumpy_sphere(10, 0.1, 1.0);  // waves of three edges
  const double volume = signed_volume(plain), rough = spread(bumpy);
  fair_taubin(plain, 30);
  EXPECT_NEAR(signed_volume(plain), volume, 3e-3 * volume);
  EXPECT_LT(spread(plain), 0.02);
  fair_taubin(bumpy, 30);
  EXPECT_LT(spread(bumpy), 0.35 * rough);
  EXPECT_NEAR(signed_volume(bumpy), volume, 5e-3 * volume);
}

TEST(FineDetail, IsFoundOnABumpyBodyAndNotOnPlainOnes) {
  const auto bumpy = skin_of(bumpy_sphere(9, 0.7, 3.0), Smooth::kAuto).smoothing;
  EXPECT_GT(bumpy->detail.share, 2 * kLeastDetailShare);
  EXPECT_TRUE(bumpy->applied);
  for (const TriangleMesh& body : {bodies::sphere(9), bodies::torus(12, 6), bodies::box(24, 20, 16)}) {
    const auto smoothing = skin_of(body, Smooth::kAuto).smoothing;
    ASSERT_TRUE(smoothing.has_value());
    EXPECT_LT(smoothing->detail.share, 0.8 * kLeastDetailShare);  // the box is small: its edges count
    EXPECT_FALSE(smoothing->applied);
    EXPECT_EQ(smoothing->added_skin_mm3, 0.0);
  }
}

TEST(FineDetail, OffIsNotLookedForAndChangesNothing) {
  const TriangleMesh body = bumpy_sphere(9, 0.7, 3.0);
  const Skin off = skin_of(body, Smooth::kOff);
  EXPECT_FALSE(off.smoothing.has_value());
  const Skin same = skin_of(bodies::sphere(8), Smooth::kAuto),
             plain = skin_of(bodies::sphere(8), Smooth::kOff);
  EXPECT_EQ(same.cavity_volume_mm3, plain.cavity_volume_mm3);
  EXPECT_EQ(same.inner_surface.vertices, plain.inner_surface.vertices);
}

TEST(FineDetail, TheCopyStaysInsideTheBody) {
  const TriangleMesh body = bumpy_sphere(9, 0.7, 3.0);
  const Skin off = skin_of(body, Smooth::kOff);
  const TriangleMesh faired = fair_surface(body, 1.0, off.voxel_mm);
  const TriangleTree tree(body);
  const auto outside = [&](const TriangleMesh& mesh) {
    int count = 0;
    for (const auto& v : mesh.vertices) count += !tree.is_inside(v);
    return count;
  };
  EXPECT_GT(outside(faired), 300);  // fairing alone does not
  const InnerCopy copy = keep_inside(faired, body, off.field, 1.0, RunContext{});
  EXPECT_EQ(outside(copy.mesh), 0);
  EXPECT_GT(signed_volume(copy.mesh), 0.9 * signed_volume(body));
  EXPECT_LT(signed_volume(copy.mesh), signed_volume(body));
}

// The wall is nowhere thinner than the skin, the rest counts as skin, and the hollow is smoother than the
// offset.
TEST(FineDetail, SmoothedHollowIsDeeperThanTheSkinBelowTheBodyAndSmoother) {
  const TriangleMesh body = bumpy_sphere(9, 0.7, 3.0);
  const Skin off = skin_of(body, Smooth::kOff), on = skin_of(body, Smooth::kOn);
  ASSERT_TRUE(on.smoothing->applied);
  const TriangleTree tree(body);
  int points = 0;
  for (double x = -9; x < 9; x += 0.47)
    for (double y = -9; y < 9; y += 0.47)
      for (double z = 0; z < 18; z += 0.47) {
        const Eigen::Vector3d p(x, y, z);
        if (on.field.at(p) > -1.0) continue;
        ++points;
        ASSERT_TRUE(tree.is_inside(p));
        ASSERT_GT(tree.distance_mm(p), 1.0 - 0.5 * on.voxel_mm) << p.transpose();
        ASSERT_LE(off.field.at(p), on.field.at(p) + 1e-5);
      }
  EXPECT_GT(points, 1000);
  EXPECT_GT(on.smoothing->added_skin_mm3, 0.0);
  EXPECT_NEAR(on.volume_mm3, off.volume_mm3 + on.smoothing->added_skin_mm3, 1e-6 * off.volume_mm3);
  EXPECT_NEAR(on.volume_mm3 + on.cavity_volume_mm3, signed_volume(body), 1e-6 * signed_volume(body));
  const auto roughness = [](const TriangleMesh& hollow) {  // 1 for a ball
    return std::pow(surface_area(hollow), 1.5) / (6.0 * std::sqrt(std::numbers::pi) * signed_volume(hollow));
  };
  EXPECT_LT(roughness(on.inner_surface) - 1.0, 0.7 * (roughness(off.inner_surface) - 1.0));
}

TEST(FineDetail, IsTheSameAtAnyThreadCount) {
  const TriangleMesh body = bumpy_sphere(7, 0.7, 3.0);
  SkinOptions options;
  options.smooth = Smooth::kOn;
  RunContext one, two;
  two.threads = 2;
  const auto a = build_skin(body, options, one), b = build_skin(body, options, two);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->inner_surface.vertices, b->inner_surface.vertices);
  EXPECT_EQ(a->volume_mm3, b->volume_mm3);
}

}  // namespace
}  // namespace skinframe
