// SPDX-License-Identifier: GPL-3.0-or-later
// The check says no to figures of the valid model, and to comparisons, that their files do not have.
#include <Eigen/Core>
#include <cstring>
#include <fstream>

#include "tests/worker/check/honest_result.h"

namespace skinframe::check {
namespace {

TEST_F(CheckTest, AVerifiedDisplacementThatItsFileDoesNotHaveIsSeen) {
  const auto lie = [](json& p) {
    json& v = p["verification"];
    const double smaller = 0.5 * v["max_displacement_mm"].get<double>();
    v["max_displacement_mm"] = smaller;
    for (json& load : v["loads"])
      load["max_displacement_mm"] = std::min(smaller, load["max_displacement_mm"].get<double>());
    v["comparison"]["rows"][0]["skin_frame"] = smaller;
    for (json& load : v["comparison"]["designs"]["skin_frame"]["loads"])
      load["max_displacement_mm"] = std::min(smaller, load["max_displacement_mm"].get<double>());
  };
  EXPECT_THAT(denied_report(lie), Names("displacement (verified)"));
}

TEST_F(CheckTest, ADeformationThatWasChangedOrLeftOutIsSeen) {
  EXPECT_THAT(denied([](const fs::path& copy) {
                const fs::path file = copy / kPrinter / "deformation-side.ply";
                std::ifstream in(file, std::ios::binary);
                std::string bytes((std::istreambuf_iterator<char>(in)), {});
                const float far = 9.0F;
                std::memcpy(&bytes[bytes.find("end_header\n") + 11 + 27 * 30 + 15], &far, sizeof far);
                std::ofstream(file, std::ios::binary) << bytes;
              }),
              Names("displacement (verified)"));
  EXPECT_THAT(denied_report([](json& p) {
                auto& files = p["files"];
                files.erase(std::find(files.begin(), files.end(), "deformation-side.ply"));
              }),
              Names("displacement (verified)"));
}

TEST_F(CheckTest, AFalseSafetyFactorAndAnUnbalancedAnswerAreSeen) {
  EXPECT_THAT(denied_report([](json& p) { p["verification"]["safety_factor"] = 1e3; }),
              Names("stress and buckling (verified)"));
  EXPECT_THAT(denied_report([](json& p) { p["verification"]["balance"]["moment"] = 1e-4; }),
              Names("stress and buckling (verified)"));
  EXPECT_THAT(denied_report([](json& p) { p["verification"]["pinch_mean_mm"] = 1e3; }),
              Names("pinch (verified)"));
  EXPECT_THAT(denied_report([](json& p) { p["verification"]["pinch"]["sites"][3]["closing_mm"] = 1e-9; }),
              Names("pinch (verified)"));
  EXPECT_THAT(
      denied_report([](json& p) { p["verification"]["pinch"]["sites"][0]["fingers_mm"][1][2] = 500; }),
      Names("pinch (verified)"));
}

// All pinches told alike, so that the map cannot tell which finger stands where.
void tell_pinches_alike(const fs::path& copy, json& verification) {
  constexpr float kClosing = 0.5F;
  constexpr std::size_t kVertexBytes = 19, kClosingAt = 15;  // three floats and a colour before it
  for (json& site : verification["pinch"]["sites"]) site["closing_mm"] = kClosing;
  verification["pinch_mean_mm"] = kClosing;
  verification["pinch_max_mm"] = kClosing;
  const fs::path file = copy / kPrinter / "pinch.ply";
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const std::string count = "element vertex ", end = "end_header\n";
  const std::size_t first = bytes.find(end) + end.size();
  const std::size_t vertices = std::stoul(bytes.substr(bytes.find(count) + count.size()));
  for (std::size_t i = 0; i < vertices; ++i)
    std::memcpy(&bytes[first + i * kVertexBytes + kClosingAt], &kClosing, sizeof kClosing);
  std::ofstream(file, std::ios::binary) << bytes;
}

// A finger presses on the middle of the skin, which is 1 mm thick: 0.7 mm further it is in the hollow.
TEST_F(CheckTest, AFingerBelowTheSkinIsSeen) {
  const auto with_finger_moved_by = [](double mm) {
    return denied([mm](const fs::path& copy) {
      json report = read_json(copy / "report.json");
      json& verification = report["printers"][0]["verification"];
      tell_pinches_alike(copy, verification);
      json& fingers = verification["pinch"]["sites"][0]["fingers_mm"];
      Eigen::Vector3d from, to;
      for (int k = 0; k < 3; ++k) {
        from[k] = fingers[0][k];
        to[k] = fingers[1][k];
      }
      from += mm * (to - from).normalized();
      fingers[0] = {from.x(), from.y(), from.z()};
      write_json(copy / "report.json", report);
    });
  };
  EXPECT_THAT(with_finger_moved_by(0), testing::Not(Names("pinch (verified)")));
  EXPECT_THAT(with_finger_moved_by(0.7), Names("pinch (verified)"));
}

TEST_F(CheckTest, AComparisonThatNamesTheWrongWinnerIsSeen) {
  EXPECT_THAT(denied_report([](json& p) {
                json& row = p["verification"]["comparison"]["rows"][1];
                row["better"] = row["better"] == "hollow" ? "skin-frame" : "hollow";
              }),
              Names("comparison with a hollow (verified)"));
}

TEST_F(CheckTest, ARowThatIsNotTheWorstOfItsDesignsLoadsIsSeen) {
  EXPECT_THAT(denied_report([](json& p) {
                json& load = p["verification"]["comparison"]["designs"]["hollow"]["loads"].back();
                load["max_displacement_mm"] = 1e3;
              }),
              Names("comparison with a hollow (verified)"));
}

TEST_F(CheckTest, AHollowOfAnotherMassIsSeen) {
  EXPECT_THAT(denied_report([](json& p) { p["verification"]["hollow_thickness_mm"] = 0.5; }),
              Names("hollow of equal mass"));
}

TEST_F(CheckTest, WhatIsNotVerifiedMustNotBringFigures) {
  EXPECT_THAT(denied_report([](json& p) { p["verification"]["label"] = "not verified"; }),
              Names("what is not verified claims nothing"));
}

}  // namespace
}  // namespace skinframe::check
