// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/fill_slivers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace skinframe {
namespace {

constexpr double kVoxelMm = 0.3;
constexpr int kReach = 20;  // nodes to each side of the origin

// Of a cavity given by the distance to its solid; positive in the solid.
openvdb::FloatGrid::Ptr level_set(const std::function<double(const openvdb::Vec3d&)>& value) {
  openvdb::initialize();
  const auto band = static_cast<float>(3 * kVoxelMm);
  auto grid = openvdb::FloatGrid::create(band);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(kVoxelMm));
  auto at = grid->getAccessor();
  for (int x = -kReach; x <= kReach; ++x)
    for (int y = -kReach; y <= kReach; ++y)
      for (int z = -kReach; z <= kReach; ++z) {
        const auto v = static_cast<float>(value(openvdb::Vec3d(x, y, z) * kVoxelMm));
        if (std::abs(v) < band)
          at.setValueOn({x, y, z}, v);
        else
          at.setValueOff({x, y, z}, std::copysign(band, v));
      }
  return grid;
}

int nodes_in_cavity(const openvdb::FloatGrid& grid) {
  int count = 0;
  const auto at = grid.getConstAccessor();
  for (int x = 1 - kReach; x < kReach; ++x)
    for (int y = 1 - kReach; y < kReach; ++y)
      for (int z = 1 - kReach; z < kReach; ++z) count += at.getValue({x, y, z}) < 0.0f;
  return count;
}

const openvdb::Vec3d kAskew = openvdb::Vec3d(0.36, 0.48, 0.8);  // of unit length, along no axis

// A gap between two planes, whose middle goes through the origin and falls on nodes.
openvdb::FloatGrid::Ptr gap(double width_mm) {
  return level_set([=](const openvdb::Vec3d& p) { return std::abs(p.dot(kAskew)) - 0.5 * width_mm; });
}

TEST(FillSlivers, AGapBelowThreeQuartersOfAVoxelIsFilledAndOneOfTwoVoxelsStays) {
  for (const double width : {0.3, 0.5, 0.75}) {
    const auto grid = gap(width * kVoxelMm);
    ASSERT_GT(nodes_in_cavity(*grid), 0);
    fill_slivers(*grid);
    EXPECT_EQ(nodes_in_cavity(*grid), 0) << width;
  }
  const auto wide = gap(2 * kVoxelMm), before = wide->deepCopy();
  fill_slivers(*wide);
  EXPECT_EQ(nodes_in_cavity(*wide), nodes_in_cavity(*before));
}

TEST(FillSlivers, WallsRoundStrutsAndCornersStayAsTheyAre) {
  const auto untouched = [](const std::function<double(const openvdb::Vec3d&)>& value) {
    const auto grid = level_set(value), before = grid->deepCopy();
    fill_slivers(*grid);
    float most = 0.0f;
    const auto at = before->getConstAccessor();
    for (auto it = grid->cbeginValueOn(); it; ++it) {
      const openvdb::Coord place = it.getCoord();
      if (std::max({std::abs(place.x()), std::abs(place.y()), std::abs(place.z())}) < kReach)
        most = std::max(most, *it - at.getValue(place));
    }
    EXPECT_GT(nodes_in_cavity(*grid), 0);
    return most;
  };
  EXPECT_EQ(untouched([](const auto& p) { return p.dot(kAskew); }), 0.0f);  // a wall
  EXPECT_EQ(untouched([](const auto& p) {                                   // a strut of radius 0.5 mm
              return 0.5 - (p - kAskew * p.dot(kAskew)).length();
            }),
            0.0f);
  EXPECT_EQ(untouched([](const auto& p) { return std::max(p.x(), p.y()); }),
            0.0f);  // two walls, a right angle
}

}  // namespace
}  // namespace skinframe
