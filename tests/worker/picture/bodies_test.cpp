// SPDX-License-Identifier: GPL-3.0-or-later
// What the pictures show, pixel by pixel where it matters.
#include "worker/picture/bodies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>

#include "worker/picture/sheet.h"
#include "worker/picture/size_curves.h"

namespace skinframe::picture {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

int count(const Image& image, const std::function<bool(const Colour&)>& is) {
  int found = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) found += is(image.at(x, y));
  return found;
}
bool red(const Colour& c) { return c[0] > 100 && c[0] > 1.6 * c[1] && c[0] > 1.6 * c[2]; }
bool violet(const Colour& c) { return c[2] > 30 && c[2] > 1.8 * c[1] && c[2] > 1.1 * c[0]; }
bool yellow(const Colour& c) { return c[0] > 100 && c[1] > 90 && c[0] > 1.8 * c[2]; }

DrawnFrame two_struts() {
  DrawnFrame frame;
  frame.struts = {{{0, 0, 0}, {100, 0, 0}, 0.5}, {{0, 0, 60}, {100, 0, 60}, 4}};
  return frame;
}

TEST(FramePicture, ThinStrutsAreDarkAndThickOnesBright) {
  const Image image = frame_picture(two_struts(), "t", 400);
  const Image thin_only = [] {
    DrawnFrame frame = two_struts();
    frame.struts.pop_back();
    frame.struts.push_back({{0, 0, 60}, {100, 0, 60}, 0.5});
    return frame_picture(frame, "t", 400);
  }();
  EXPECT_GT(count(image, yellow), 2000);
  EXPECT_GT(count(image, violet), 200);
  EXPECT_LT(count(thin_only, yellow), 1200);  // the colour bar alone
}

TEST(FramePicture, SupportsAreOfAHueThatNoRadiusHas) {
  DrawnFrame frame = two_struts();
  EXPECT_EQ(count(frame_picture(frame, "t", 400), red), 0);
  frame.supports = {{{50, 0, 0}, {50, 0, 60}, 1}};
  EXPECT_GT(count(frame_picture(frame, "t", 400), red), 300);
}

TEST(FramePicture, OneRadiusAndNoExtentAreDrawnAsWell) {
  DrawnFrame frame;
  frame.struts = {{{5, 5, 5}, {5, 5, 5}, 2}};
  EXPECT_GT(count(frame_picture(frame, "t", 120), violet), 1000);
  frame.struts[0].radius_mm = 0;
  EXPECT_EQ(frame_picture(frame, "t", 120).width(), 120);
}

// A box with corners at +-half, its faces outwards.
void add_box(TriangleMesh& mesh, const Vector3d& half, bool outward) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                               k & 4 ? half.z() : -half.z());
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces)
    for (auto t : {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
      if (!outward) std::swap(t[1], t[2]);
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
}

TEST(CutawayPicture, TheCutShowsTheWallFilledAndTheCavityOpen) {
  TriangleMesh solid;
  add_box(solid, {50, 20, 40}, true);
  TriangleMesh shell = solid;
  add_box(shell, {45, 15, 35}, false);
  const int filled = count(cutaway_picture(solid, "t", 500), red);
  const int wall = count(cutaway_picture(shell, "t", 500), red);
  const int legend = 150;                                 // its square, at most
  const double share = 1.0 - (90.0 * 70) / (100.0 * 80);  // of the cut face
  EXPECT_NEAR(double(wall) / filled, share, 0.025);       // rims blend into what is behind them
  EXPECT_GT(filled, 20 * legend);
}

TEST(CutawayPicture, WhatIsLeftFitsEvenWhereTheCutHasNoVertex) {
  TriangleMesh box;
  add_box(box, {50, 20, 40}, true);
  const Image image = cutaway_picture(box, "t", 400);
  for (int k = 0; k < 400; ++k) {
    EXPECT_EQ(image.at(0, k), kWhite);
    EXPECT_EQ(image.at(399, k), kWhite);
    EXPECT_EQ(image.at(k, 399), kWhite);
  }
  int columns_of_cut = 0;
  for (int x = 0; x < 400; ++x) columns_of_cut += red(image.at(x, 200));
  EXPECT_GT(columns_of_cut, 280);
}

TEST(CutawayPicture, TheCutLiesAcrossTheShorterHorizontalSide) {
  TriangleMesh wide, deep;
  add_box(wide, {50, 20, 40}, true);
  add_box(deep, {20, 50, 40}, true);
  const int one = count(cutaway_picture(wide, "t", 400), red),
            other = count(cutaway_picture(deep, "t", 400), red);
  EXPECT_NEAR(double(one) / other, 1, 0.03);
}

TEST(Cumulative, ItCountsWhatIsNoLarger) {
  const std::vector<Vector2d> expected = {{0, 0}, {1, 0}, {1, 2}, {3, 2}, {3, 3}, {4, 3}};
  EXPECT_EQ(cumulative({3, 1, 1}, 4), expected);
  EXPECT_EQ(cumulative({}, 4), (std::vector<Vector2d>{{0, 0}, {4, 0}}));
}

TEST(CurvesPicture, ALaterStageWithFewerStrutsEndsLower) {
  std::vector<double> many(1000), few(300);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = 0.5 + 0.001 * double(i);
  for (std::size_t i = 0; i < few.size(); ++i) few[i] = 0.5 + 0.003 * double(i);
  const Image image =
      curves_picture({{"initial", many, many}, {"after geometry", few, few}}, StrutSize::kRadius, "t", 800);
  // Down the right rim of the plot: the first curve's grey, then the last one's blue, 70 % of the way down.
  const auto blue = [](const Colour& c) { return c[2] > 150 && c[0] < 60; };
  int blue_y = -1, grey_y = -1;
  const int x = 800 - 36;
  for (int y = 100; y < 560; ++y) {
    const Colour c = image.at(x, y);
    if (blue(c) && blue_y < 0) blue_y = y;
    if (std::abs(c[0] - 150) < 12 && std::abs(c[2] - 160) < 12 && grey_y < 0) grey_y = y;
  }
  ASSERT_GT(grey_y, 0);
  ASSERT_GT(blue_y, grey_y + 200);
}

TEST(Ticks, AreThreeToEightAndRound) {
  for (const double high : {0.013, 0.5, 0.99, 1.0, 3.0, 7.9, 25.0, 812.0, 60000.0}) {
    const double step = tick_step(0, high);
    EXPECT_LE(high / step, 8) << high;
    EXPECT_GE(high / step, 2.5) << high;
  }
  EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_text(-1e-17, 0.05), "0.00");
  EXPECT_EQ(tick_text(1500, 500), "1500");
}

}  // namespace
}  // namespace skinframe::picture
