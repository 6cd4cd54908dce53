// SPDX-License-Identifier: Apache-2.0
// A slicer's own G-code of extrusion results, support detection off: merged mesh and external struts in
// place. No part of a layer starts in the air.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/integration/printed_layers.h"
#include "tests/integration/process.h"

namespace skinframe::integration {
namespace {

constexpr char kPrinter[] = "makerbot-replicator-2";
constexpr std::size_t kHeader = 80, kCount = 4, kTriangle = 50;  // bytes of a binary STL file

// Binary STL files as one, each where it stands.
void join_stl(const std::vector<std::filesystem::path>& parts, const std::filesystem::path& out) {
  std::string triangles;
  for (const auto& part : parts) {
    const std::string bytes = read_file(part);
    ASSERT_GT(bytes.size(), kHeader + kCount) << part;
    triangles += bytes.substr(kHeader + kCount);
  }
  const auto count = static_cast<std::uint32_t>(triangles.size() / kTriangle);
  std::string head(kHeader + kCount, '\0');
  std::memcpy(head.data() + kHeader, &count, kCount);
  std::ofstream(out, std::ios::binary) << head << triangles;
}

class SlicedPrint : public testing::Test {
 protected:
  std::filesystem::path results() const { return scratch_ / "result" / kPrinter; }

  void make(const std::string& sample) {
    const std::string mesh = scratch_ / (sample + ".stl");
    ASSERT_EQ(run({binary("skinframe"), "sample", sample, "--out", mesh}, scratch_.path()).exit_code, 0);
    const Ran made = run({binary("skinframe"), "run", mesh, "--printer", kPrinter, "--size", "45", "--verify",
                          "off", "--out", scratch_ / "result"},
                         scratch_.path());
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }

  std::vector<PrintedLayer> slice(const std::filesystem::path& mesh) {
    const auto gcode = scratch_ / "print.gcode";
    const Ran ran = run({"/usr/bin/prusa-slicer",
                         "--export-gcode",
                         "--output",
                         gcode,
                         "--layer-height",
                         "0.2",
                         "--first-layer-height",
                         "0.2",
                         "--nozzle-diameter",
                         "0.4",
                         "--skirts",
                         "0",
                         "--perimeters",
                         "2",
                         "--fill-density",
                         "100%",
                         "--fill-pattern",
                         "rectilinear",
                         "--bed-shape",
                         "0x0,225x0,225x145,0x145",
                         "--center",
                         "112,72",
                         mesh},
                        scratch_.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    const std::string text = read_file(gcode);
    EXPECT_NE(text.find("; support_material = 0"), std::string::npos)
        << "the slicer makes no supports of its own";
    std::istringstream in(text);
    return read_layers(in);
  }

  static std::string told(const std::vector<FloatingPart>& parts) {
    std::string text;
    for (const FloatingPart& part : parts)
      text += std::to_string(part.area_mm2) + " mm2 at " + std::to_string(part.x_mm) + ", " +
              std::to_string(part.y_mm) + ", " + std::to_string(part.z_mm) + "\n";
    return text;
  }

  Scratch scratch_;
};

TEST_F(SlicedPrint, ABallThatHangsOverStartsInTheAirNowhereButWithoutItsStrutsOutsideItDoes) {
  ASSERT_NO_FATAL_FAILURE(make("hanging-ball"));
  const auto all = scratch_ / "all.stl";
  ASSERT_NO_FATAL_FAILURE(
      join_stl({results() / "skin-frame.stl", results() / "support-struts-external.stl"}, all));
  const auto layers = slice(all);
  EXPECT_GT(layers.size(), 200u);
  const auto floating = parts_in_the_air(layers, LayerRule{});
  EXPECT_TRUE(floating.empty()) << told(floating);
  EXPECT_FALSE(parts_in_the_air(slice(results() / "skin-frame.stl"), LayerRule{}).empty());
}

TEST_F(SlicedPrint, ARingStartsInTheAirNowhere) {
  ASSERT_NO_FATAL_FAILURE(make("ring"));
  const auto all = scratch_ / "all.stl";
  ASSERT_NO_FATAL_FAILURE(
      join_stl({results() / "skin-frame.stl", results() / "support-struts-external.stl"}, all));
  const auto floating = parts_in_the_air(slice(all), LayerRule{});
  EXPECT_TRUE(floating.empty()) << told(floating);
}

std::vector<PrintedLayer> layers_of(const std::string& gcode) {
  std::istringstream in(gcode);
  return read_layers(in);
}

TEST(PrintedLayers, OnlyMovesThatFeedAndGoAreStrokesWithAbsoluteAndRelativeExtrusion) {
  const auto layers = layers_of(
      "M82\nG1 Z.2 F7800\nG1 X0 Y0\nG1 E2\nG92 E0\nG1 X5 E.5 ; out\nG1 X9\nG1 Y1 E.4\n"
      "M83\nG1 Z0.4\nG1 X0 Y0\nG1 X5 E.5\nG1 X10 E.5\nG1 X12 E-1\n");
  ASSERT_EQ(layers.size(), 2u);
  EXPECT_EQ(layers[0].z_mm, 0.2);
  ASSERT_EQ(layers[0].strokes.size(), 1u) << "a travel and a retraction are none";
  EXPECT_EQ(layers[0].strokes[0].to_x, 5);
  EXPECT_EQ(layers[1].strokes.size(), 2u);
}

TEST(PrintedLayers, AStrokeBesideTheLayerBelowIsInTheAirAndOneThatTouchesItIsNot) {
  const std::string first = "M83\nG1 Z.2\nG1 X0 Y0\nG1 X10 E1\nG1 Z.4\n";
  EXPECT_TRUE(parts_in_the_air(layers_of(first + "G1 X0 Y.5\nG1 X10 Y.5 E1\n"), {}).empty());
  const auto beside = parts_in_the_air(layers_of(first + "G1 X0 Y1.5\nG1 X10 Y1.5 E1\n"), {});
  ASSERT_EQ(beside.size(), 1u);
  EXPECT_EQ(beside[0].z_mm, 0.4);
  EXPECT_NEAR(beside[0].area_mm2, 10.45 * 0.45, 0.5);
  EXPECT_TRUE(parts_in_the_air(layers_of(first + "G1 X5 Y0\nG1 X5 Y9 E1\n"), {}).empty())
      << "held at its end";
}

}  // namespace
}  // namespace skinframe::integration
