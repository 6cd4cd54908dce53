// SPDX-License-Identifier: GPL-3.0-or-later
// The check says no to figures of the valid model, and to comparisons, that their files do not have.
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
