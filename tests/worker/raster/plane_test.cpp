// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures, strokes, text, colours, files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "tests/fixture/temporary_folder.h"
#include "worker/raster/colour_map.h"
#include "worker/raster/strokes.h"
#include "worker/raster/text.h"
#include "worker/raster/write_png.h"

namespace skinframe {
namespace {

using testing::HasSubstr;

double ink(const Image& image) {  // in pixels of black on white
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) sum += (255 - image.at(x, y)[1]) / 255.0;
  return sum;
}
constexpr Colour kBlack{0, 0, 0};

// L* of CIE 1976, from 8-bit sRGB.
double lightness(const Colour& colour) {
  const double weights[3] = {0.2126, 0.7152, 0.0722};
  double y = 0;
  for (int k = 0; k < 3; ++k) {
    const double c = colour[k] / 255.0;
    y += weights[k] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return 116 * std::cbrt(y) - 16;
}

TEST(Viridis, LightnessRisesWithTheNumberInEvenSteps) {
  std::vector<double> steps;
  for (int k = 0; k <= 32; ++k) steps.push_back(lightness(viridis(k / 32.0)));
  const double even = (steps.back() - steps.front()) / 32;
  EXPECT_GT(even, 2);
  for (std::size_t k = 1; k < steps.size(); ++k) {
    EXPECT_GT(steps[k] - steps[k - 1], 0.5 * even) << k;
    EXPECT_LT(steps[k] - steps[k - 1], 1.6 * even) << k;
  }
}

TEST(Viridis, BeyondItsEndsItStays) {
  EXPECT_EQ(viridis(-3), viridis(0));
  EXPECT_EQ(viridis(7), viridis(1));
  EXPECT_EQ(viridis(std::nan("")), viridis(0));
}

TEST(Polyline, ItsInkIsLengthTimesWidthHoweverItIsDivided) {
  Image one(120, 120, kWhite), many(120, 120, kWhite);
  const Eigen::Vector2d a(20.3, 30.7), b(97.1, 88.2);
  draw_polyline(one, {a, b}, 3, kBlack);
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k <= 60; ++k) points.emplace_back(a + (b - a) * k / 60.0);
  draw_polyline(many, points, 3, kBlack);
  const double area = 3 * (b - a).norm() + 2.25 * M_PI;
  EXPECT_NEAR(ink(one), area, 0.02 * area);
  EXPECT_NEAR(ink(many), ink(one), 0.002 * area);
}

TEST(Rectangle, PartsOfPixelsCountAsTheirParts) {
  Image image(40, 40, kWhite);
  fill_rectangle(image, 3.25, 4.5, 20.75, 10, kBlack);
  EXPECT_NEAR(ink(image), 17.5 * 5.5, 0.2);
  fill_rectangle(image, -1e9, -1e9, 1e9, 1e9, kBlack);
  EXPECT_EQ(ink(image), 1600);
}

TEST(Text, ItIsDrawnWithinItsWidthAboveItsLine) {
  Image image(400, 80, kWhite);
  draw_text(image, 200, 50, "0.5 mm", 30, kBlack, Align::kCentre);
  const double width = text_width_px("0.5 mm", 30);
  double outside = 0;
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 400; ++x)
      if (std::abs(x + 0.5 - 200) > width / 2 + 1 || y > 52 || y < 20) outside += 255 - image.at(x, y)[1];
  EXPECT_EQ(outside, 0);
  EXPECT_GT(ink(image), 300);
  EXPECT_NEAR(text_width_px("ab", 30), text_width_px("a", 30) + text_width_px("b", 30), 1e-9);
}

TEST(Text, ItsInkGrowsWithTheSquareOfItsSize) {
  Image small(300, 100, kWhite), large(300, 100, kWhite);
  draw_text(small, 5, 60, "skin", 20, kBlack);
  draw_text(large, 5, 60, "skin", 60, kBlack);
  EXPECT_NEAR(ink(large) / ink(small), 9, 0.25);
}

TEST(Text, WhatItHasNoLetterForIsAQuestionMark) {
  const auto drawn = [](std::string_view text) {
    Image image(60, 40, kWhite);
    draw_text(image, 5, 30, text, 24, kBlack);
    return image;
  };
  EXPECT_EQ(drawn("\xE9\xB1\xBC"), drawn("?"));  // a letter of three bytes
  EXPECT_EQ(drawn("\xFF"), drawn("?"));          // no UTF-8
  EXPECT_EQ(drawn("\xC3"), drawn("?"));          // cut off
  EXPECT_EQ(drawn("\n"), drawn("?"));
  EXPECT_NE(drawn("\xC3\xBC"), drawn("?"));  // u with dots, of Latin-1
}

TEST(Text, TooLongATextEndsInDotsAndFits) {
  EXPECT_EQ(fit_text("fish", 20, 400), "fish");
  const std::string cut = fit_text(std::string(500, 'w') + "\xC3\xBC", 20, 200);
  EXPECT_THAT(cut, HasSubstr("..."));
  EXPECT_LE(text_width_px(cut, 20), 200);
}

TEST(Image, WhatIsPastedOverTheRimIsLeftOut) {
  Image image(10, 10, kWhite);
  image.paste(Image(6, 6, kBlack), 7, -3);
  image.paste(Image(6, 6, kBlack), 50, 50);
  EXPECT_EQ(ink(image), 9);
}

TEST(WritePng, WhatIsReadBackIsThePictureAndSamePicturesAreSameBytes) {
  const test::TemporaryFolder folder;
  Image image(37, 23, kWhite);
  draw_text(image, 2, 18, "ok", 16, {200, 30, 90});
  for (const char* name : {"a.png", "b.png"}) ASSERT_TRUE(write_png(image, folder.path() / name).ok());
  const auto bytes = [&](const char* name) {
    std::ifstream in(folder.path() / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes("a.png"), bytes("b.png"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.png.part"));

  png_image read{};
  read.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&read, (folder.path() / "a.png").c_str()), 0);
  read.format = PNG_FORMAT_RGB;
  ASSERT_EQ(read.width, 37U);
  ASSERT_EQ(read.height, 23U);
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(read));
  ASSERT_NE(png_image_finish_read(&read, nullptr, pixels.data(), 0, nullptr), 0);
  for (int y = 0; y < 23; ++y)
    EXPECT_TRUE(std::equal(image.row(y), image.row(y) + 3 * 37, &pixels[std::size_t(y) * 3 * 37])) << y;
}

TEST(WritePng, AFolderThatIsNotThereIsNamed) {
  const Status written = write_png(Image(2, 2, kWhite), "/no-such-folder/a.png");
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(written.error().message, HasSubstr("/no-such-folder/a.png"));
}

}  // namespace
}  // namespace skinframe
