// SPDX-License-Identifier: GPL-3.0-or-later
// The check says yes to a result as it was made, and no to each lie told in a copy of it.
#include "worker/check/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/worker/pipeline/small_job.h"

namespace skinframe::check {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kPrinter = "sinterstation-hiq";

json read_json(const fs::path& path) {
  std::ifstream in(path);
  return json::parse(in);
}
void write_json(const fs::path& path, const json& document) { std::ofstream(path) << document; }

// One honest result for all tests of this file.
class CheckTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    JobRequest request = test::sample_job("egg", 36, 60, folder_->path());
    request.loads = {{"side", Place::kTop, {1, 0, 0}, 5}};
    request.options.verify = true;
    RunContext context;
    auto outcomes = run_pipeline(request, honest(), PipelineObserver{}, context);
    ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
    ASSERT_TRUE(outcomes->front().succeeded()) << outcomes->front().detail;
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static fs::path honest() { return folder_->path() / "honest"; }

  // The names of the claims that do not hold, after `spoil` changed a copy.
  static std::vector<std::string> denied(const std::function<void(const fs::path&)>& spoil,
                                         const fs::path& from = honest()) {
    const fs::path copy = folder_->path() / "copy";
    fs::remove_all(copy);
    fs::copy(from, copy, fs::copy_options::recursive);
    spoil(copy);
    RunContext context;
    auto verdicts = check_directory(copy, context);
    if (!verdicts.ok()) return {"error: " + verdicts.error().message};
    std::vector<std::string> names;
    for (const Verdict& verdict : *verdicts)
      for (const Claim& claim : verdict.claims)
        if (!claim.holds) names.push_back(claim.name);
    return names;
  }
  static std::vector<std::string> denied_report(const std::function<void(json&)>& lie,
                                                const fs::path& from = honest()) {
    return denied(
        [&](const fs::path& copy) {
          json report = read_json(copy / "report.json");
          lie(report["printers"][0]);
          write_json(copy / "report.json", report);
        },
        from);
  }
  static std::vector<std::string> denied_frame(const std::function<void(json&)>& lie) {
    return denied([&](const fs::path& copy) {
      json frame = read_json(copy / kPrinter / "frame.json");
      lie(frame);
      write_json(copy / kPrinter / "frame.json", frame);
    });
  }

  static test::TemporaryFolder* folder_;
};
test::TemporaryFolder* CheckTest::folder_ = nullptr;

MATCHER_P(Names, name, "") { return std::find(arg.begin(), arg.end(), name) != arg.end(); }

TEST_F(CheckTest, AnHonestResultHoldsInEveryClaim) {
  RunContext context;
  auto verdicts = check_directory(honest(), context);
  ASSERT_TRUE(verdicts.ok()) << verdicts.error().message;
  EXPECT_TRUE(verdicts->front().holds()) << to_text(*verdicts);
}

TEST_F(CheckTest, AMissingTriangleIsNotWatertight) {
  EXPECT_THAT(denied([](const fs::path& copy) {
                const fs::path stl = copy / kPrinter / "skin-frame.stl";
                std::ifstream in(stl, std::ios::binary);
                std::string bytes((std::istreambuf_iterator<char>(in)), {});
                std::uint32_t count = 0;
                std::memcpy(&count, &bytes[80], 4);
                --count;
                std::memcpy(&bytes[80], &count, 4);
                bytes.resize(bytes.size() - 50);
                std::ofstream(stl, std::ios::binary) << bytes;
              }),
              Names("watertight"));
}

TEST_F(CheckTest, AWallThinnerThanTheSkinIsSeen) {
  EXPECT_THAT(denied_report([](json& printer) { printer["profile"]["skin_thickness_mm"] = 1.4; }),
              Names("skin thickness"));
}

// Changes the cavity's corners in the exported mesh; triangles that share a corner keep sharing it.
void move_cavity(const fs::path& copy, const std::function<void(Eigen::Vector3f&)>& move) {
  const std::size_t outer = read_json(copy / "report.json")["mesh"]["triangles"];
  const fs::path stl = copy / kPrinter / "skin-frame.stl";
  std::ifstream in(stl, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t at = 84 + 50 * outer; at + 50 <= bytes.size(); at += 50) {
    for (std::size_t corner = at + 12; corner < at + 48; corner += 12) {
      Eigen::Vector3f place;
      std::memcpy(place.data(), &bytes[corner], 12);
      move(place);
      std::memcpy(&bytes[corner], place.data(), 12);
    }
  }
  std::ofstream(stl, std::ios::binary) << bytes;
}

TEST_F(CheckTest, AWallThinnedInTheFileIsSeenByRays) {
  const auto names = denied(
      [](const fs::path& copy) { move_cavity(copy, [](Eigen::Vector3f& place) { place.x() += 0.5f; }); });
  EXPECT_THAT(names, Names("walls"));
}

TEST_F(CheckTest, ACavityThatCutsItselfOrTheSurfaceIsSeen) {
  const auto itself = denied([](const fs::path& copy) {
    bool is_first = true;
    Eigen::Vector3f one;
    move_cavity(copy, [&](Eigen::Vector3f& place) {
      if (std::exchange(is_first, false)) one = place;
      if (place == one) place += Eigen::Vector3f(60.0f, 0.7f, 0.3f);  // out of the body, wherever it stood
    });
  });
  EXPECT_THAT(itself, Names("no self-intersection beyond the input's"));
  const auto surface = denied(
      [](const fs::path& copy) { move_cavity(copy, [](Eigen::Vector3f& place) { place.x() += 5.0f; }); });
  EXPECT_THAT(surface, Names("no self-intersection beyond the input's"));
}

TEST_F(CheckTest, PairsThatCutEachOtherAreDeniedThoughTheyAreToldOf) {
  EXPECT_THAT(denied_report([](json& p) { p["crossings"] = 1; }),
              Names("no self-intersection beyond the input's"));
  EXPECT_THAT(denied_report([](json& p) { p["compact"]["crossings"] = 1; }),
              Names("the compact mesh adds no self-intersection"));
}

TEST_F(CheckTest, ACompactMeshThatCutsItselfIsSeen) {
  EXPECT_THAT(denied([](const fs::path& copy) {
                const fs::path stl = copy / kPrinter / "skin-frame-compact.stl";
                std::ifstream in(stl, std::ios::binary);
                std::string bytes((std::istreambuf_iterator<char>(in)), {});
                std::array<float, 3> one{}, place{};
                std::memcpy(one.data(), &bytes[96], 12);
                for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50) {
                  for (std::size_t corner = at + 12; corner < at + 48; corner += 12) {
                    std::memcpy(place.data(), &bytes[corner], 12);
                    if (place != one) continue;
                    for (float& x : place) x += 4.0f;
                    std::memcpy(&bytes[corner], place.data(), 12);
                  }
                }
                std::ofstream(stl, std::ios::binary) << bytes;
              }),
              Names("the compact mesh adds no self-intersection"));
}

TEST_F(CheckTest, FalseVolumesAndWeightsAreSeen) {
  EXPECT_THAT(
      denied_report([](json& p) { p["printed_volume_mm3"] = p["printed_volume_mm3"].get<double>() * 0.99; }),
      Names("printed volume"));
  EXPECT_THAT(denied_report([](json& p) { p["weight_g"] = p["weight_g"].get<double>() * 0.9; }),
              Names("printed ratio and weight"));
  EXPECT_THAT(
      denied_report([](json& p) { p["solid_volume_mm3"] = p["solid_volume_mm3"].get<double>() * 1.01; }),
      Names("outer surface is the solid"));
  EXPECT_THAT(denied_report([](json& p) { p["skin_volume_mm3"] = p["skin_volume_mm3"].get<double>() * 0.8; }),
              Names("skin volume"));
  EXPECT_THAT(
      denied_report([](json& p) { p["frame_volume_mm3"] = p["frame_volume_mm3"].get<double>() * 0.99; }),
      Names("nominal volumes"));
  EXPECT_THAT(
      denied_report([](json& p) { p["topology_volume_mm3"] = p["size_volume_mm3"].get<double>() * 1.1; }),
      Names("no volume rises from stage to stage"));
}

TEST_F(CheckTest, APackageOfAnotherBodyOrUnitIsSeen) {
  EXPECT_THAT(denied([](const fs::path& copy) {
                fs::copy_file(copy / kPrinter / "frame-beams.3mf", copy / kPrinter / "skin-frame.3mf",
                              fs::copy_options::overwrite_existing);
              }),
              Names("skin-frame.3mf is the mesh"));
  EXPECT_THAT(denied([](const fs::path& copy) {
                fs::copy_file(copy / kPrinter / "skin-frame.3mf", copy / kPrinter / "frame-beams.3mf",
                              fs::copy_options::overwrite_existing);
              }),
              Names("frame-beams.3mf is the frame"));
  const auto broken =
      denied([](const fs::path& copy) { fs::resize_file(copy / kPrinter / "skin-frame.3mf", 5000); });
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_NE(broken[0].find("skin-frame.3mf"), std::string::npos) << broken[0];
}

TEST_F(CheckTest, ACompactMeshThatIsFarOffOrMiscountedIsSeen) {
  EXPECT_THAT(denied_report([](json& p) { p["compact"]["deviation_mm"] = 0.0; }),
              Names("compact mesh is near the full one"));
  EXPECT_THAT(denied_report([](json& p) { p["compact"]["triangles"] = 7; }), Names("compact mesh"));
  EXPECT_THAT(denied_report([](json& p) {
                p["compact"]["volume_mm3"] = p["compact"]["volume_mm3"].get<double>() * 1.01;
              }),
              Names("compact mesh"));
}

TEST_F(CheckTest, AStrutThinnerThanThePrinterCanIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["struts"][3]["radius_mm"] = 0.4; }), Names("radii"));
}

TEST_F(CheckTest, AStrutTooThickForTheSkinIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["struts"][3]["radius_mm"] = 1.6; }), Names("radii"));
}

// A strut of the radius given that runs 3 mm below the first skin strut.
void add_internal_strut(json& frame, double radius_mm) {
  json& nodes = frame["nodes"];
  const auto count = nodes.size();
  std::array<double, 3> centre{};
  for (const json& node : nodes)
    for (int k = 0; k < 3; ++k) centre[k] += node[k].get<double>() / static_cast<double>(count);
  for (const char* end : {"a", "b"}) {
    json node = nodes[frame["struts"][0][end].get<std::size_t>()];
    double distance = 0;
    for (int k = 0; k < 3; ++k) distance += std::pow(centre[k] - node[k].get<double>(), 2);
    for (int k = 0; k < 3; ++k)
      node[k] = node[k].get<double>() + 3 / std::sqrt(distance) * (centre[k] - node[k].get<double>());
    nodes.push_back(node);
    frame["skin_weight_n"].push_back(0.0);
    for (json& load_case : frame["load_cases"]) load_case["displacements_mm"].push_back({0.0, 0.0, 0.0});
  }
  frame["struts"].push_back({{"a", count},
                             {"b", count + 1},
                             {"skin", false},
                             {"radius_mm", radius_mm},
                             {"min_radius_mm", 0.5},
                             {"max_radius_mm", 5.0}});
}

TEST_F(CheckTest, AnInternalStrutThatStandsOutOfTheInsideByItsRadiusIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { add_internal_strut(frame, 5.0); }),
              Names("internal struts inside the skin"));
  EXPECT_THAT(denied_frame([](json& frame) { add_internal_strut(frame, 0.5); }),
              testing::Not(Names("internal struts inside the skin")));
}

TEST_F(CheckTest, ASlenderStrutIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["material"]["slenderness"] = 5; }), Names("slenderness"));
}

TEST_F(CheckTest, ATornTriangulationIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["skin_triangles"].erase(0); }),
              Names("skin triangulation"));
}

TEST_F(CheckTest, AMovedNodeBreaksEquilibrium) {
  EXPECT_THAT(
      denied_frame([](json& frame) { frame["nodes"][20][0] = frame["nodes"][20][0].get<double>() + 1.0; }),
      Names("equilibrium (paper model)"));
}

TEST_F(CheckTest, AFalseDisplacementIsSeen) {
  EXPECT_THAT(
      denied_report([](json& p) { p["max_displacement_mm"] = 0.5 * p["max_displacement_mm"].get<double>(); }),
      Names("displacement (paper model)"));
}

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

TEST_F(CheckTest, ALimitThatIsNotKeptIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["displacement_limit_mm"] = 1e-4; }),
              Names("displacement (paper model)"));
}

TEST_F(CheckTest, AStressBeyondStrengthIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) { frame["material"]["tensile_strength_mpa"] = 1e-3; }),
              Names("stresses (paper model)"));
}

TEST_F(CheckTest, ACentreOfGravityOutsideTheBaseIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) {
                frame["skin_mass"]["centroid_mm"] = {500, 0, 10};
              }),
              Names("balance"));
}

TEST_F(CheckTest, AMarginOfThePrintThatTheMeshDoesNotHaveIsSeen) {
  EXPECT_THAT(denied_report([](json& p) { p["printed_balance_margin_mm"] = 99; }), Names("balance"));
  EXPECT_THAT(denied_report([](json& p) { p.erase("printed_balance_margin_mm"); }), Names("balance"));
}

TEST_F(CheckTest, ALowerBoundIsVerifiedForTheFrameThatWasOptimised) {
  const json honest_report = read_json(honest() / "report.json");
  const double bound = honest_report["printers"][0]["lower_bound_mm3"];
  const char* proven = "lower bound of the sized volume, proven";
  EXPECT_THAT(denied_report([&](json& p) { p["lower_bound_mm3"] = 1.0001 * bound; }), Names(proven));
  const auto denied_initial = [&](const std::function<void(json&)>& lie) {
    return denied([&](const fs::path& copy) {
      json initial = read_json(copy / kPrinter / "initial-frame.json");
      lie(initial);
      write_json(copy / kPrinter / "initial-frame.json", initial);
    });
  };
  EXPECT_THAT(denied_initial([](json& f) { f["lower_bound_proof"] = nullptr; }), Names(proven));
  EXPECT_THAT(denied_initial([](json& f) { f["displacement_limit_mm"] = 0.01; }), Names(proven));
}

TEST_F(CheckTest, ATraySmallerThanTheBodyIsSeen) {
  EXPECT_THAT(denied_report([](json& p) { p["profile"]["tray_mm"] = {20, 20, 20}; }), Names("fits the tray"));
}

TEST_F(CheckTest, ANodeWithoutAPathToTheBaseIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) {
                frame["nodes"].push_back({0, 0, 20});
                frame["skin_weight_n"].push_back(0.0);
              }),
              Names("every node stands on the base"));
}

TEST_F(CheckTest, AMeshWithoutTheStrutsIsSeen) {
  EXPECT_THAT(denied_frame([](json& frame) {
                // Struts that run through the void: from one skin node straight across the body.
                frame["struts"].push_back({{"a", 0},
                                           {"b", 30},
                                           {"skin", false},
                                           {"radius_mm", 0.6},
                                           {"min_radius_mm", 0.5},
                                           {"max_radius_mm", 5}});
              }),
              Names("struts are printed"));
}

TEST_F(CheckTest, AResultCalledInfeasibleThatKeepsItsLimitsIsSeen) {
  EXPECT_THAT(denied_report([](json& printer) {
                printer["termination"]["reason"] = "INFEASIBLE";
                printer["violated_constraint"] = "displacement";
              }),
              Names("infeasible"));
}

TEST_F(CheckTest, FalseFiguresOfSmoothedDetailAreSeen) {
  const fs::path smoothed = folder_->path() / "smoothed";
  JobRequest request = test::sample_job("relief", 44, 60, folder_->path());
  request.options.smooth = Smooth::kOn;
  request.options.no_optimize = true;
  RunContext context;
  const auto outcomes = run_pipeline(request, smoothed, PipelineObserver{}, context);
  ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
  ASSERT_TRUE(outcomes->front().succeeded()) << outcomes->front().detail;
  const json told = read_json(smoothed / "report.json")["printers"][0];
  EXPECT_TRUE(told["smoothing"]["applied"]);
  EXPECT_GT(told["smoothing"]["added_skin_mm3"], 0.0);
  EXPECT_THAT(denied([](const fs::path&) {}, smoothed), testing::IsEmpty());
  EXPECT_THAT(denied_report([](json& p) { p["skin_volume_mm3"] = p["skin_volume_mm3"].get<double>() * 0.5; },
                            smoothed),
              Names("skin volume"));
  EXPECT_THAT(
      denied_report([](json& p) { p["smoothing"]["added_skin_mm3"] = p["skin_volume_mm3"].get<double>(); },
                    smoothed),
      Names("smoothed detail"));
}

TEST_F(CheckTest, AMissingOrBrokenFileIsAnErrorThatNamesIt) {
  const auto error = denied([](const fs::path& copy) { fs::remove(copy / kPrinter / "frame.json"); });
  ASSERT_EQ(error.size(), 1u);
  EXPECT_NE(error[0].find("frame.json"), std::string::npos) << error[0];
  const auto broken =
      denied([](const fs::path& copy) { std::ofstream(copy / "report.json") << "{\"printers\": ["; });
  EXPECT_NE(broken.at(0).find("not JSON"), std::string::npos) << broken[0];
  const auto index = denied_frame([](json& frame) { frame["struts"][0]["a"] = 100000; });
  EXPECT_NE(index.at(0).find("struts[0].a"), std::string::npos) << index[0];
}

}  // namespace
}  // namespace skinframe::check
