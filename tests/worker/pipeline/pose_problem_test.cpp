// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/pose_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/worker/pipeline/box_body.h"

namespace skinframe {
namespace {

using test::box_frame;
using test::box_solid;

int held_axes(const std::vector<std::array<bool, 3>>& fixed) {
  int count = 0;
  for (const auto& axes : fixed)
    for (const bool held : axes) count += held ? 1 : 0;
  return count;
}

TEST(HoldContact, TheLeastHoldsEveryContactNodeInZAndThreeMotionsInThePlane) {
  const auto fixed = hold_contact(box_frame(), {0, 1, 2, 3}, Supports::kLeast);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(fixed[i][2]);
  for (int i = 4; i < 8; ++i) EXPECT_FALSE(fixed[i][0] || fixed[i][1] || fixed[i][2]);
  EXPECT_EQ(held_axes(fixed), 4 + 2 + 1);
}

TEST(HoldContact, TheLeastStopsTurningAboutTheUpwardAxis) {
  const Frame frame = box_frame();
  const auto fixed = hold_contact(frame, {0, 1, 2, 3}, Supports::kLeast);
  // A turn about the node held in x and y moves the other held node along its held axis.
  int centre = -1, rim = -1, axis = -1;
  for (int i = 0; i < 4; ++i) {
    if (fixed[i][0] && fixed[i][1])
      centre = i;
    else if (fixed[i][0] || fixed[i][1]) {
      rim = i;
      axis = fixed[i][0] ? 0 : 1;
    }
  }
  ASSERT_GE(centre, 0);
  ASSERT_GE(rim, 0);
  const Eigen::Vector3d arm = frame.nodes_mm[rim] - frame.nodes_mm[centre];
  const Eigen::Vector3d motion = Eigen::Vector3d::UnitZ().cross(arm);
  EXPECT_GT(std::abs(motion[axis]), 0.5 * arm.norm());
}

TEST(HoldContact, PinnedHoldsAllAxesOfTheContact) {
  EXPECT_EQ(held_axes(hold_contact(box_frame(), {0, 1, 2, 3}, Supports::kPinned)), 12);
}

TEST(Balance, AutoIsEnforcedOnlyWhereTheSolidStands) {
  Contact standing = find_contact(box_solid());
  ASSERT_TRUE(standing.stands);
  EXPECT_EQ(decide_balance(BalanceMode::kAuto, standing), BalanceState::kEnforced);
  standing.stands = false;
  EXPECT_EQ(decide_balance(BalanceMode::kAuto, standing), BalanceState::kNotStanding);
  EXPECT_EQ(decide_balance(BalanceMode::kRequire, standing), BalanceState::kEnforced);
  EXPECT_EQ(decide_balance(BalanceMode::kOff, standing), BalanceState::kOff);
}

TEST(Balance, HalfPlanesHoldExactlyInsideTheReserve) {
  const auto planes = balance_half_planes(find_contact(box_solid()).hull, kBalanceReserveMm);
  ASSERT_EQ(planes.size(), 4u);
  const auto inside = [&](double x, double y) {
    for (const HalfPlane& plane : planes)
      if (plane.normal.dot(Eigen::Vector2d(x, y)) > plane.offset_mm) return false;
    return true;
  };
  EXPECT_TRUE(inside(0, 0));
  EXPECT_TRUE(inside(10 - kBalanceReserveMm - 1e-9, 15 - kBalanceReserveMm - 1e-9));
  EXPECT_FALSE(inside(10 - kBalanceReserveMm + 1e-6, 0));
  EXPECT_FALSE(inside(0, -15 + kBalanceReserveMm - 1e-6));
}

TEST(Balance, TheReserveAsksNoMoreThanTheSolidItselfHas) {
  Contact contact;
  contact.margin_mm = 0.2;
  EXPECT_DOUBLE_EQ(balance_reserve_mm(contact), 0.1);
  contact.margin_mm = 20;
  EXPECT_DOUBLE_EQ(balance_reserve_mm(contact), kBalanceReserveMm);
  contact.margin_mm = -3;
  EXPECT_DOUBLE_EQ(balance_reserve_mm(contact), 0.0);
}

}  // namespace
}  // namespace skinframe
