// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/profile/fit_printable_length.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/fixture/temporary_folder.h"

namespace skinframe {
namespace {

using Struts = std::vector<CalibrationPoint>;

CalibrationFit fit(const Struts& struts) {
  auto made = fit_printable_length(struts);
  EXPECT_TRUE(made.ok()) << made.error().message;
  return std::move(made).value();
}

// The oracle: isotonic regression by pooling adjacent violators (Barlow et al. 1972). Of struts in the order
// of their angles, all different.
std::vector<double> pooled(const Struts& struts) {
  struct Block {
    double sum;
    int count;
    double mean() const { return sum / count; }
  };
  std::vector<Block> blocks;
  for (const CalibrationPoint& strut : struts) {
    blocks.push_back({strut.length_mm, 1});
    while (blocks.size() > 1 && blocks.back().mean() > blocks[blocks.size() - 2].mean()) {
      blocks[blocks.size() - 2].sum += blocks.back().sum;
      blocks[blocks.size() - 2].count += blocks.back().count;
      blocks.pop_back();
    }
  }
  std::vector<double> out;
  for (const Block& block : blocks)
    out.insert(out.end(), static_cast<std::size_t>(block.count), block.mean());
  return out;
}

TEST(FitPrintableLength, FallingLengthsAreMetExactly) {
  const CalibrationFit f = fit({{30, 80}, {45, 40}, {60, 22.5}, {90, 7}});
  ASSERT_EQ(f.points.size(), 4u);
  EXPECT_NEAR(*f.points[0].length_mm, 80, 1e-3);
  EXPECT_NEAR(*f.points[2].length_mm, 22.5, 1e-3);
  EXPECT_NEAR(*f.points[3].length_mm, 7, 1e-3);
  EXPECT_LT(f.rms_mm, 1e-6);
  EXPECT_TRUE(f.reaches_flat());
}

TEST(FitPrintableLength, ARiseIsLevelledToTheMean) {
  const CalibrationFit f = fit({{40, 50}, {50, 20}, {60, 30}, {90, 10}});
  EXPECT_NEAR(f.fitted_mm[1], 25, 1e-6);
  EXPECT_NEAR(f.fitted_mm[2], 25, 1e-6);
  EXPECT_NEAR(f.largest_mm, 5, 1e-6);
  EXPECT_NEAR(f.rms_mm, std::sqrt(50.0 / 4), 1e-6);
}

TEST(FitPrintableLength, StrutsOfOneAngleAreAveraged) {
  const CalibrationFit f = fit({{45, 30}, {90, 8}, {45, 34}, {90, 12}});
  EXPECT_EQ(f.points.size(), 2u);
  EXPECT_NEAR(f.fitted_mm[0], 32, 1e-6);
  EXPECT_NEAR(f.fitted_mm[1], 10, 1e-6);
}

TEST(FitPrintableLength, IsIsotonicRegressionOnNoisyStruts) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 6);
  for (int round = 0; round < 20; ++round) {
    Struts struts;
    for (int i = 0; i < 30; ++i) {
      const double angle = 30 + 60.0 * i / 29;
      struts.push_back({angle, std::max(0.5, 60 - 0.6 * angle + noise(random))});
    }
    const CalibrationFit f = fit(struts);
    const std::vector<double> expected = pooled(struts);
    for (std::size_t i = 0; i < struts.size(); ++i)
      EXPECT_NEAR(f.fitted_mm[i], expected[i], 1e-4) << "round " << round << " strut " << i;
  }
}

TEST(FitPrintableLength, TheCurveIsOneThatAProfileTakesAndNeverMoreThanTheFit) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(0, 90), length(0.01, 200);
  Struts struts = {{90, 5}};
  for (int i = 0; i < 300; ++i) struts.push_back({angle(random), length(random)});  // more angles than knots
  const CalibrationFit f = fit(struts);
  EXPECT_EQ(f.points.size(), static_cast<std::size_t>(kMostKnots));
  const auto curve = PrintableLength::make(f.points, false, "test struts");
  ASSERT_TRUE(curve.ok()) << curve.error().message;
  for (std::size_t i = 0; i < struts.size(); ++i) {
    if (struts[i].angle_deg < f.steepest_deg()) continue;
    EXPECT_LE(curve->length_mm(struts[i].angle_deg * std::numbers::pi / 180), f.fitted_mm[i] + 1e-5);
  }
}

TEST(FitPrintableLength, ACurveThatEndsBeforeFlatStrutsSaysSo) {
  const CalibrationFit f = fit({{30, 80}, {70, 15}});
  EXPECT_FALSE(f.reaches_flat());
  EXPECT_EQ(f.flattest_deg(), 70);
}

class ReadCalibration : public testing::Test {
 protected:
  Result<Struts> read(const std::string& text) { return read_calibration(folder_.write("points.csv", text)); }
  void expect_refused(const std::string& text, const std::string& says) {
    const auto points = read(text);
    ASSERT_FALSE(points.ok()) << text;
    EXPECT_NE(points.error().message.find(says), std::string::npos) << points.error().message;
  }
  test::TemporaryFolder folder_;
};

TEST_F(ReadCalibration, StrutsCommentsAndWhatSpreadsheetsAdd) {
  const auto points = read(
      "\xEF\xBB\xBF"
      "angle_deg,length_mm\r\n# PLA, 210 degrees\r\n\r\n45, 30.5\r\n90,8e0\r\n");
  ASSERT_TRUE(points.ok()) << points.error().message;
  ASSERT_EQ(points->size(), 2u);
  EXPECT_EQ((*points)[0].length_mm, 30.5);
  EXPECT_EQ((*points)[1].length_mm, 8);
  EXPECT_EQ((*points)[1].line, 5);
}

TEST_F(ReadCalibration, WhatIsWrongIsSaidWithFileAndLine) {
  const std::string h = "angle_deg,length_mm\n";
  expect_refused("", "points.csv:1: nothing is in it");
  expect_refused("45,30\n", "points.csv:1: the first line must be `angle_deg,length_mm`");
  expect_refused(h + "45,30\n45;20\n", "points.csv:3: not two columns");
  expect_refused(h + "45,30,1\n", "points.csv:2: not two columns");
  expect_refused(h + "91,30\n", "points.csv:2: angle_deg");
  expect_refused(h + "nan,30\n", "points.csv:2: angle_deg");
  expect_refused(h + "45,\n", "points.csv:2: length_mm");
  expect_refused(h + "45,0\n", "points.csv:2: length_mm");
  expect_refused(h + "45,3 0\n", "points.csv:2: length_mm");
  expect_refused(h + "45,inf\n", "points.csv:2: length_mm");
  expect_refused(h + "45,30\n45,31\n", "points.csv:3: struts of 1 angle");
  std::string many = h;
  for (int i = 0; i <= 10'000; ++i) many += "45,30\n";
  expect_refused(many, "more than 10000 struts");
  expect_refused(std::string((1 << 20) + 1, ' '), "bytes are too many");
}

TEST_F(ReadCalibration, NoFileIsSaid) {
  const auto points = read_calibration(folder_.path() / "none.csv");
  ASSERT_FALSE(points.ok());
  EXPECT_EQ(points.error().kind, ErrorKind::kIo);
}

}  // namespace
}  // namespace skinframe
