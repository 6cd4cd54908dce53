// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/place_loads.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/worker/pipeline/box_body.h"

namespace skinframe {
namespace {

using test::box_frame;
using test::box_solid;

Eigen::Vector3d sum_of(const LoadCase& load_case) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& f : load_case.force_n) sum += f;
  return sum;
}

TEST(PlaceLoads, GravityAloneIsAlwaysTheFirstCase) {
  auto cases = place_loads({}, box_solid(), box_frame());
  ASSERT_TRUE(cases.ok());
  ASSERT_EQ(cases->cases.size(), 1u);
  EXPECT_EQ(cases->cases.front().name, kSelfWeight);
  EXPECT_TRUE(cases->cases.front().gravity);
  EXPECT_EQ(sum_of(cases->cases.front()).norm(), 0.0);
}

TEST(PlaceLoads, ForceOfACaseIsTheSumOfItsLoads) {
  const std::vector<Load> loads = {{"side", Place::kTop, {20, 0, 0}, 5},
                                   {"down", Place::kRight, {0, 0, -5}, 3},
                                   {"side", Place::kFront, {0, 7, 0}, 8}};
  auto cases = place_loads(loads, box_solid(), box_frame());
  ASSERT_TRUE(cases.ok());
  ASSERT_EQ(cases->cases.size(), 3u);
  EXPECT_LT((sum_of(cases->cases[1]) - Eigen::Vector3d(20, 7, 0)).norm(), 1e-9);
  EXPECT_LT((sum_of(cases->cases[2]) - Eigen::Vector3d(0, 0, -5)).norm(), 1e-9);
}

TEST(PlaceLoads, ForceActsAtTheMiddleOfItsPatch) {
  const Frame frame = box_frame();
  auto cases = place_loads({{"push", Eigen::Vector3d(4, -3, 40), {0, 0, -10}, 6}}, box_solid(), frame);
  ASSERT_TRUE(cases.ok());
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < frame.nodes_mm.size(); ++i)
    moment += frame.nodes_mm[i].cross(cases->cases[1].force_n[i]);
  // Cells are half a millimetre wide: the patch's middle is met to a fraction of that.
  const Eigen::Vector3d wanted = Eigen::Vector3d(4, -3, 40).cross(Eigen::Vector3d(0, 0, -10));
  EXPECT_LT((moment - wanted).norm() / 10, 0.3);
}

TEST(PlaceLoads, APatchSmallerThanACellActsOnTheNearestTriangle) {
  auto cases = place_loads({{"pin", Eigen::Vector3d(1, 1, 40), {0, 0, -1}, 0.01}}, box_solid(), box_frame());
  ASSERT_TRUE(cases.ok());
  EXPECT_LT((sum_of(cases->cases[1]) - Eigen::Vector3d(0, 0, -1)).norm(), 1e-9);
}

TEST(PlaceLoads, APointFarFromTheSurfaceIsRefusedByName) {
  auto cases = place_loads({{"lost", Eigen::Vector3d(0, 0, 90), {0, 0, -1}, 5}}, box_solid(), box_frame());
  ASSERT_FALSE(cases.ok());
  EXPECT_EQ(cases.error().kind, ErrorKind::kInvalidInput);
  EXPECT_NE(cases.error().message.find("\"lost\""), std::string::npos);
}

TEST(PlaceLoads, TheTopOfABoxIsTheMiddleOfItsUpperFace) {
  EXPECT_LT((place_point_mm(box_solid(), Place::kTop) - Eigen::Vector3d(0, 0, 40)).norm(), 1e-6);
  EXPECT_LT((place_point_mm(box_solid(), Place::kLeft) - Eigen::Vector3d(-10, 0, 20)).norm(), 1e-6);
  EXPECT_LT((place_point_mm(box_solid(), Place::kBack) - Eigen::Vector3d(0, 15, 20)).norm(), 1e-6);
}

}  // namespace
}  // namespace skinframe
