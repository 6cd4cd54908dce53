// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/touching_boxes.h"

#include <gtest/gtest.h>

#include <random>

namespace skinframe {
namespace {

// Small boxes all over, and a few that reach across all of them.
std::vector<Eigen::AlignedBox3f> scattered(int count) {
  std::mt19937 generator(5489);
  const auto upto = [&](float most) { return most * static_cast<float>(generator()) / 4294967296.0F; };
  std::vector<Eigen::AlignedBox3f> boxes;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f at(upto(10), upto(10), upto(10));
    const float reach = i % 50 == 0 ? 8.0F : 0.5F;
    boxes.emplace_back(at, at + Eigen::Vector3f(upto(reach), upto(reach), upto(reach)));
  }
  return boxes;
}

TEST(TouchingPairs, AreThoseThatEveryPairByItselfTells) {
  for (const int count : {1, 2, 4, 17, 3000}) {
    const auto boxes = scattered(count);
    const auto is_kept = [](int i, int j) { return (i + j) % 3 != 0; };
    std::vector<std::pair<int, int>> wanted;
    for (int i = 0; i < count; ++i)
      for (int j = i + 1; j < count; ++j)
        if (is_kept(i, j) && boxes[i].intersects(boxes[j])) wanted.emplace_back(i, j);
    EXPECT_EQ(touching_pairs(boxes, is_kept), wanted) << count;
  }
  EXPECT_TRUE(touching_pairs({}, [](int, int) { return true; }).empty());
}

TEST(TouchingPairs, ACornerInCommonIsEnough) {
  const std::vector<Eigen::AlignedBox3f> boxes{{Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 1, 1)},
                                               {Eigen::Vector3f(1, 1, 1), Eigen::Vector3f(2, 2, 2)},
                                               {Eigen::Vector3f(2.5F, 0, 0), Eigen::Vector3f(3, 1, 1)}};
  const std::vector<std::pair<int, int>> wanted{{0, 1}};
  EXPECT_EQ(touching_pairs(boxes, [](int, int) { return true; }), wanted);
}

}  // namespace
}  // namespace skinframe
