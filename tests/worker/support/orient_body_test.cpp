// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/orient_body.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "tests/worker/support/small_prints.h"

namespace skinframe {
namespace {

using test::bridges_10_mm;

TriangleMesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                               i & 4 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// A plate of 60 x 60 x 10 mm on a stem of 20 x 20 x 40 mm: shells that touch.
TriangleMesh table() {
  TriangleMesh mesh = box({-10, -10, 0}, {10, 10, 40});
  const TriangleMesh plate = box({-30, -30, 40}, {30, 30, 50});
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), plate.vertices.begin(), plate.vertices.end());
  for (const auto& t : plate.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return mesh;
}

TEST(RankAttitudes, ATableUpsideDownNeedsLessThanUpright) {
  const auto ranked = rank_attitudes(table(), bridges_10_mm(), OrientOptions{});
  const auto place_of = [&](const Eigen::Vector3d& up) {
    return std::find_if(ranked.begin(), ranked.end(),
                        [&](const Attitude& a) {
                          return (a.rotation * up).isApprox(Eigen::Vector3d::UnitZ(), 1e-9);
                        }) -
           ranked.begin();
  };
  EXPECT_LT(place_of(-Eigen::Vector3d::UnitZ()), place_of(Eigen::Vector3d::UnitZ()));
  EXPECT_LT(place_of(Eigen::Vector3d::UnitZ()), static_cast<std::ptrdiff_t>(ranked.size()))
      << "its own is always among them where it stands";
  for (const Attitude& attitude : ranked) {
    EXPECT_NEAR(attitude.rotation.determinant(), 1.0, 1e-9);
    EXPECT_GT(attitude.margin_mm, 0.0);
  }
  for (std::size_t k = 1; k < ranked.size(); ++k) EXPECT_GE(ranked[k].support_mm3, ranked[k - 1].support_mm3);
}

TEST(RankAttitudes, ItsOwnAttitudeWinsTies) {
  const auto ranked = rank_attitudes(box({-10, -10, 0}, {10, 10, 20}), bridges_10_mm(), OrientOptions{});
  EXPECT_TRUE(ranked.front().rotation.isIdentity()) << "all six are alike";
}

TEST(RankAttitudes, ALevelRoofCostsItsAreaOverTheCircleOfOneStrut) {
  OrientOptions options;
  options.skin_thickness_mm = 1.0;
  const auto ranked = rank_attitudes(box({-30, -30, 0}, {30, 30, 40}), bridges_10_mm(), options);
  const double each = 0.4 * 0.4 * M_PI * 38.0, holds = M_PI * 5 * 5;
  for (const Attitude& attitude : ranked) {
    if (!attitude.rotation.isIdentity()) continue;
    EXPECT_NEAR(attitude.support_mm3, 3600 / holds * each, 0.01 * 3600 / holds * each);
  }
}

}  // namespace
}  // namespace skinframe
