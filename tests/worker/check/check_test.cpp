// SPDX-License-Identifier: GPL-3.0-or-later
// The check says yes to a result as it was made, and no to each lie told in a copy of its report and meshes.
#include "worker/check/check.h"

#include <cstring>
#include <fstream>
#include <utility>

#include "tests/worker/check/honest_result.h"

namespace skinframe::check {
namespace {

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

TEST_F(CheckTest, ATraySmallerThanTheBodyIsSeen) {
  EXPECT_THAT(denied_report([](json& p) { p["profile"]["tray_mm"] = {20, 20, 20}; }), Names("fits the tray"));
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
