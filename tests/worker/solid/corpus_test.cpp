// SPDX-License-Identifier: GPL-3.0-or-later
// Published meshes, read and repaired; what each must give stands in the corpus's own manifest. The corpus is
// not part of the project: the program is only built where the corpus is (or must be, CI=true).
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "worker/mesh/read_mesh.h"
#include "worker/solid/place.h"
#include "worker/solid/repair.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;

std::filesystem::path models() {
  const char* given = std::getenv("SKINFRAME_MODELS");
  return given != nullptr ? given : SKINFRAME_DEFAULT_MODELS;
}

nlohmann::json manifest() {
  std::ifstream file(models() / "manifest.json");
  return nlohmann::json::parse(file, nullptr, false);
}

nlohmann::json entry(const std::string& list, const std::string& id) {
  const nlohmann::json whole = manifest();
  if (!whole.is_object()) return {};
  for (const auto& candidate : whole[list]) {
    if (candidate["id"] == id) return candidate;
  }
  return {};
}

Result<RepairOutcome> read_and_repair(const nlohmann::json& model) {
  RunContext context;
  auto file = read_mesh(models() / model["file"].get<std::string>(), {}, context);
  if (!file.ok()) return file.error();
  return repair(put_on_plate(scale_to_largest_edge(std::move(file->mesh), 200)), {}, context);
}

void expect_volume_of_the_manifest(const nlohmann::json& model, double volume_mm3) {
  ASSERT_EQ(model["size_mm"], 200);
  const double expected = model["facts"]["volume_200mm_mm3"];
  EXPECT_NEAR(volume_mm3 / expected, 1, model["volume_tolerance"].get<double>());
}

std::string id_of(const ::testing::TestParamInfo<const char*>& tested) { return tested.param; }

class GoodMesh : public ::testing::TestWithParam<const char*> {};

TEST_P(GoodMesh, GivesASolidOfTheVolumeInTheManifest) {
  const nlohmann::json model = entry("good", GetParam());
  ASSERT_FALSE(model.is_null()) << "no " << GetParam() << " in the manifest of " << models();
  const auto outcome = read_and_repair(model);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  expect_volume_of_the_manifest(model, outcome->solid.volume_mm3());
  EXPECT_EQ(outcome->solid.mesh().triangles.size(), model["facts"]["faces"].get<std::size_t>());
}

INSTANTIATE_TEST_SUITE_P(Corpus, GoodMesh,
                         ::testing::Values("plane", "nefertiti_70k", "spot_low", "fish", "hand", "human",
                                           "goathead", "koala_low", "scorpion_low", "skull_low", "torus",
                                           "wingnut", "penguin", "tray_bottom", "tube", "plate_holes",
                                           "quadknot", "seven_eighths_cube", "bob_small"),
                         id_of);

class AcceptedOddity : public ::testing::TestWithParam<const char*> {};

TEST_P(AcceptedOddity, GivesASolidOfTheVolumeInTheManifest) {
  const nlohmann::json model = entry("bad", GetParam());
  ASSERT_FALSE(model.is_null()) << "no " << GetParam() << " in the manifest of " << models();
  const auto outcome = read_and_repair(model);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  expect_volume_of_the_manifest(model, outcome->solid.volume_mm3());
}

INSTANTIATE_TEST_SUITE_P(Corpus, AcceptedOddity,
                         ::testing::Values("obj_ngons", "obj_negative_indices", "ply_big_endian_f64",
                                           "nonmanifold_joined_tets"),
                         id_of);

struct Refusal {
  const char* id;
  const char* names;  // what the sentence has to hold
};

class RefusedMesh : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedMesh, IsRefusedByTheNameOfItsDefect) {
  const nlohmann::json model = entry("bad", GetParam().id);
  ASSERT_FALSE(model.is_null()) << "no " << GetParam().id << " in the manifest of " << models();
  const auto outcome = read_and_repair(model);
  ASSERT_FALSE(outcome.ok());
  EXPECT_THAT(outcome.error().message, HasSubstr(GetParam().names));
}

INSTANTIATE_TEST_SUITE_P(Corpus, RefusedMesh,
                         ::testing::Values(Refusal{"open_plane_many_holes", "341 boundary edges"},
                                           Refusal{"dupfaces_chair", "open"},
                                           Refusal{"triangle_soup", "100 openings"},
                                           Refusal{"empty_stl", "no triangle"}, Refusal{"moebius", "Moebius"},
                                           Refusal{"nan_vertex", "triangle 37: corner 1 is not finite"},
                                           Refusal{"truncated", "room for 1616"},
                                           Refusal{"lying_count", "4294967295 triangles"}),
                         [](const auto& tested) { return std::string(tested.param.id); });

TEST(Corpus, ContentDecidesNotTheName) {
  const nlohmann::json model = entry("bad", "stl_named_obj");
  ASSERT_FALSE(model.is_null());
  EXPECT_TRUE(read_and_repair(model).ok());
}

TEST(Corpus, EveryGoodMeshOfTheManifestIsTestedHere) {
  const nlohmann::json whole = manifest();
  ASSERT_TRUE(whole.is_object()) << "no manifest.json in " << models();
  std::set<std::string> tested;
  const auto* suite = ::testing::UnitTest::GetInstance();
  for (int s = 0; s < suite->total_test_suite_count(); ++s) {
    for (int t = 0; t < suite->GetTestSuite(s)->total_test_count(); ++t) {
      const std::string name = suite->GetTestSuite(s)->GetTestInfo(t)->name();
      tested.insert(name.substr(name.find('/') + 1));
    }
  }
  for (const auto& model : whole["good"]) {
    const bool threemf = model["file"].get<std::string>().ends_with(".3mf");  // not read yet
    EXPECT_TRUE(threemf || tested.count(model["id"]) == 1) << model["id"];
  }
}

}  // namespace
}  // namespace skinframe
