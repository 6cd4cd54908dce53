// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/internal_struts.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/worker/skin/bodies.h"
#include "worker/frame/sample_frame.h"

namespace skinframe {
namespace {

TEST(SegmentDistance, ClosedForms) {
  const Eigen::Vector3d o(0, 0, 0), x(10, 0, 0);
  EXPECT_DOUBLE_EQ(segment_distance_mm(o, x, {5, -3, 2}, {5, 3, 2}), 2.0);   // crossing in projection
  EXPECT_DOUBLE_EQ(segment_distance_mm(o, x, {2, 4, 0}, {8, 4, 0}), 4.0);    // parallel, side by side
  EXPECT_DOUBLE_EQ(segment_distance_mm(o, x, {13, 4, 0}, {20, 4, 0}), 5.0);  // parallel, one after the other
  EXPECT_DOUBLE_EQ(segment_distance_mm(o, x, {12, 0, 0}, {12, 5, 5}), 2.0);  // end to end
  EXPECT_DOUBLE_EQ(segment_distance_mm(o, o, {3, 4, 0}, {3, 4, 0}), 5.0);    // points
}

TEST(SegmentDistance, IsThatOfASlowSearch) {
  std::mt19937_64 random(9);
  const auto point = [&] {
    const auto c = [&] { return static_cast<double>(random() % 2001) / 100.0 - 10.0; };
    return Eigen::Vector3d(c(), c(), c());
  };
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d a0 = point(), a1 = point(), b0 = point(), b1 = point();
    double slow = 1e9;
    for (int i = 0; i <= 200; ++i)
      for (int j = 0; j <= 200; ++j)
        slow = std::min(slow, (a0 + (a1 - a0) * (i / 200.0) - b0 - (b1 - b0) * (j / 200.0)).norm());
    const double fast = segment_distance_mm(a0, a1, b0, b1);
    EXPECT_LE(fast, slow + 1e-12);
    EXPECT_NEAR(fast, slow, 0.15);
  }
}

SampledFrame sampled(const TriangleMesh& body, int internal_nodes) {
  RunContext context;
  auto skin = build_skin(body, {.thickness_mm = 1.0}, context);
  EXPECT_TRUE(skin.ok());
  FrameOptions options;
  options.plate.tensile_modulus_mpa = 1586;
  options.internal_nodes = internal_nodes;
  options.slenderness = 60;
  auto frame = sample_frame(*skin, options, context);
  EXPECT_TRUE(frame.ok()) << frame.error().message;
  return std::move(frame.value());
}

TEST(InternalStruts, NoTwoStandNearerThanTheirLeastRadiiAllow) {
  const Frame frame = sampled(bodies::torus(26, 12), 120).frame;
  std::size_t internal = 0;
  for (std::size_t i = 0; i < frame.struts.size(); ++i) {
    const Strut& s = frame.struts[i];
    if (s.is_skin) continue;
    ++internal;
    for (std::size_t j = 0; j < frame.struts.size(); ++j) {
      const Strut& t = frame.struts[j];
      if (i == j || s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b) continue;
      const double least = std::max(0.5, frame.length_mm(s) / 60) + std::max(0.5, frame.length_mm(t) / 60);
      EXPECT_GE(segment_distance_mm(frame.nodes_mm[s.a], frame.nodes_mm[s.b], frame.nodes_mm[t.a],
                                    frame.nodes_mm[t.b]),
                least - 1e-9);
    }
  }
  EXPECT_GT(internal, 200u);
}

TEST(InternalStruts, EveryInternalNodeHasThreeOrMore) {
  const Frame frame = sampled(bodies::torus(26, 12), 120).frame;
  std::vector<int> degree(frame.nodes_mm.size(), 0);
  for (const Strut& s : frame.struts) {
    ++degree[s.a];
    ++degree[s.b];
  }
  for (std::size_t i = 0; i < degree.size(); ++i) EXPECT_GE(degree[i], 3) << i;
}

}  // namespace
}  // namespace skinframe
