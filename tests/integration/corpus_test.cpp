// SPDX-License-Identifier: Apache-2.0
// Every file of the corpus through the whole job, client to files, with radii at their bounds: what its
// manifest accepts gives files whose every claim is checked and which hold the manifest's volume; what it
// refuses leaves a sentence, the documented exit code, and no file behind.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/integration/process.h"

namespace skinframe::integration {
namespace {

using nlohmann::json;

// Large enough for an inside in every model that has one at 200 mm, small enough for a test of them all.
constexpr double kTestedSizeMm = 100;

std::filesystem::path models() {
  const char* given = std::getenv("SKINFRAME_MODELS");
  return given != nullptr ? given : SKINFRAME_DEFAULT_MODELS;
}

std::map<std::string, json> read_manifest() {
  std::ifstream file(models() / "manifest.json");
  const json whole = json::parse(file, nullptr, false);
  std::map<std::string, json> entries;
  if (!whole.is_object()) return entries;
  for (const char* list : {"good", "bad"}) {
    for (const json& entry : whole[list]) entries[entry["id"]] = entry;
  }
  return entries;
}

const std::map<std::string, json>& manifest() {
  static const std::map<std::string, json> entries = read_manifest();
  return entries;
}

std::vector<std::string> all_ids() {
  std::vector<std::string> ids;
  for (const auto& [id, entry] : manifest()) ids.push_back(id);
  return ids;
}

class WholeJob : public testing::TestWithParam<std::string> {};

TEST_P(WholeJob, EndsAsTheManifestSays) {
  const json& entry = manifest().at(GetParam());
  const std::string expected = entry["expected"];
  Scratch scratch;
  const auto out = scratch / "result";
  std::vector<std::string> words = {binary("skinframe"),
                                    "run",
                                    models() / entry["file"].get<std::string>(),
                                    "--printer",
                                    "sinterstation-hiq",
                                    "--no-optimize",
                                    "--out",
                                    out};
  const bool own_size = entry["size_mm"].is_null();
  if (!own_size) words.insert(words.end(), {"--size", std::to_string(kTestedSizeMm)});
  const Ran ran = run(words, scratch.path(), Seconds(300));
  if (ran.exit_code != 0) {
    EXPECT_EQ(ran.exit_code, 3) << ran.err;
    EXPECT_TRUE(expected == "reject" || expected == "either") << ran.err;
    EXPECT_NE(ran.err.find("INVALID_INPUT: "), std::string::npos) << "no sentence: " << ran.err;
    EXPECT_TRUE(!std::filesystem::exists(out) || std::filesystem::is_empty(out)) << "files are left behind";
    return;
  }
  ASSERT_NE(expected, "reject") << ran.out;
  const Ran check = run({binary("skinframe"), "check", out}, scratch.path());
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
  const json report = json::parse(read_file(out / "report.json"));
  const json& printer = report.at("printers").at(0);
  const double solid = printer.at("solid_volume_mm3"), printed = printer.at("printed_volume_mm3");
  EXPECT_GT(printed, 0);
  EXPECT_LE(printed, solid * 1.0001);
  EXPECT_EQ(report.at("mesh").at("volume_mm3").get<double>(), solid);
  // An open surface has no volume of its own: the test of the repair says what the bust must have.
  if (entry["facts"].value("watertight", false) && !entry["volume_tolerance"].is_null()) {
    const double factor = own_size ? 1 : std::pow(kTestedSizeMm / 200, 3);
    const double wanted =
        entry["facts"][own_size ? "volume_file_units" : "volume_200mm_mm3"].get<double>() * factor;
    EXPECT_NEAR(solid / wanted, 1, entry["volume_tolerance"].get<double>());
  }
  if (expected == "accept_after_repair") {
    EXPECT_FALSE(report.at("mesh").at("repairs").empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, WholeJob, testing::ValuesIn(all_ids()),
                         [](const auto& tested) { return tested.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(WholeJob);

TEST(Corpus, IsThere) { EXPECT_FALSE(manifest().empty()) << "no manifest.json with models in " << models(); }

}  // namespace
}  // namespace skinframe::integration
