// SPDX-License-Identifier: GPL-3.0-or-later
// Every file of the corpus, read, scaled and repaired, against what its manifest says must come of it. The
// corpus is not part of the project: the program is only built where the corpus is (or must be, CI=true).
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <map>

#include "tests/fixture/corpus.h"
#include "worker/mesh/read_mesh.h"
#include "worker/solid/place.h"
#include "worker/solid/repair.h"

namespace skinframe {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kOpenBust = "open_demosthenes";

// What a repair has to tell. Every file that must be repaired stands here.
const std::map<std::string, std::vector<std::string>> kRepairs = {
    {kOpenBust, {"capped the flat cut of 67 edges"}},
    {"nonmanifold_joined_tets", {"inner wall"}},
    {"selfintersect_A", {"338 pairs of triangles cut each other"}},
    {"human", {"united a surface with itself where", "pairs of triangles cut each other"}},
    {"wingnut", {"pairs of triangles cut each other; accepted"}},
    {"threemf_inches", {"converted inch to mm (times 25.4)", "joined 8 vertices to the edges"}},
    {"obj_ngons", {"polygons into triangles"}},
};

struct Repaired {
  TriangleMesh placed;  // as it was before the repair
  RepairOutcome outcome;
  std::vector<std::string> notes;
};

Result<Repaired> read_and_repair(const json& entry) {
  RunContext context;
  auto file = read_mesh(test::corpus_folder() / entry["file"].get<std::string>(), {}, context);
  if (!file.ok()) return file.error();
  TriangleMesh mesh = std::move(file.value().mesh);
  if (!entry["size_mm"].is_null())
    mesh = scale_to_largest_edge(std::move(mesh), entry["size_mm"].get<double>());
  mesh = put_on_plate(std::move(mesh));
  auto outcome = repair(mesh, {}, context);
  if (!outcome.ok()) return outcome.error();
  return Repaired{std::move(mesh), std::move(outcome).value(), file->notes};
}

// The manifest sums an open surface about the mean of its vertices and so leaves out the cone from there to
// the opening: for the bust, 8 % of its volume. `mesh` as it was read, in mm.
double volume_with_flat_cap(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  std::vector<std::pair<int, int>> rim;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& [edge, count] : uses) {
    if (uses.count({edge.second, edge.first}) > 0) continue;
    rim.push_back(edge);
    middle += mesh.vertices[edge.first];
  }
  TriangleMesh capped = mesh;
  capped.vertices.push_back(middle / static_cast<double>(rim.size()));
  const int apex = static_cast<int>(mesh.vertices.size());
  for (const auto& [a, b] : rim) capped.triangles.push_back({b, a, apex});
  return signed_volume(capped);
}

// In the manifest's facts; the files' own unit where no size is asked for.
double expected_volume(const json& entry) {
  return entry["facts"][entry["size_mm"].is_null() ? "volume_file_units" : "volume_200mm_mm3"];
}

void expect_told(const std::string& id, const Repaired& repaired) {
  std::string told;
  for (const auto* list : {&repaired.notes, &repaired.outcome.repairs, &repaired.outcome.warnings}) {
    for (const std::string& sentence : *list) told += sentence + "\n";
  }
  const auto wanted = kRepairs.find(id);
  if (wanted == kRepairs.end()) return;
  for (const std::string& words : wanted->second) EXPECT_THAT(told, HasSubstr(words));
}

class CorpusFile : public ::testing::TestWithParam<std::string> {};

TEST_P(CorpusFile, ComesOutAsItsManifestSays) {
  const json& entry = test::corpus().at(GetParam());
  const std::string expected = entry["expected"];
  const auto repaired = read_and_repair(entry);
  RecordProperty("outcome", repaired.ok() ? "accepted" : repaired.error().message);
  if (!repaired.ok()) {
    ASSERT_TRUE(expected == "reject" || expected == "either") << repaired.error().message;
    EXPECT_EQ(repaired.error().kind, ErrorKind::kInvalidInput);
    const auto words = test::corpus_refusals().find(GetParam());
    ASSERT_NE(words, test::corpus_refusals().end())
        << "refused, and nothing says with what words: " << repaired.error().message;
    for (const std::string& word : words->second) EXPECT_THAT(repaired.error().message, HasSubstr(word));
    return;
  }
  ASSERT_NE(expected, "reject") << "accepted with " << repaired->outcome.solid.volume_mm3() << " mm3";
  const Solid& solid = repaired->outcome.solid;
  if (!entry["volume_tolerance"].is_null() && entry["facts"].contains("volume_file_units")) {
    const double expected_mm3 =
        GetParam() == kOpenBust ? volume_with_flat_cap(repaired->placed) : expected_volume(entry);
    EXPECT_NEAR(solid.volume_mm3() / expected_mm3, 1, entry["volume_tolerance"].get<double>());
  }
  if (expected == "accept_after_repair") {
    EXPECT_THAT(repaired->outcome.repairs, Not(IsEmpty()));
  }
  if (entry["facts"].value("watertight", false) &&
      entry["facts"].value("self_intersecting_face_pairs", 1) == 0) {
    // What is whole keeps its triangles.
    EXPECT_EQ(solid.mesh().triangles.size(), entry["facts"]["faces"].get<std::size_t>());
  }
  if (entry["size_mm"].is_null()) {
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(solid.box().extent()[k], entry["facts"]["bbox_file_units"][k].get<double>(), 1e-3);
  }
  expect_told(GetParam(), *repaired);
}

INSTANTIATE_TEST_SUITE_P(Corpus, CorpusFile, ::testing::ValuesIn(test::corpus_ids()),
                         [](const auto& tested) { return tested.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CorpusFile);  // the next test says that the corpus is absent

TEST(Corpus, IsThereAndHoldsWhatIsExpectedOfItByName) {
  ASSERT_FALSE(test::corpus().empty()) << "no manifest.json with models in " << test::corpus_folder();
  for (const auto& [id, words] : test::corpus_refusals()) EXPECT_EQ(test::corpus().count(id), 1u) << id;
  for (const auto& [id, words] : kRepairs) EXPECT_EQ(test::corpus().count(id), 1u) << id;
  for (const auto& [id, entry] : test::corpus()) {
    if (entry["expected"] == "reject") {
      EXPECT_EQ(test::corpus_refusals().count(id), 1u) << id;
    }
    if (entry["expected"] == "accept_after_repair") {
      EXPECT_EQ(kRepairs.count(id), 1u) << id;
    }
  }
}

// Why the bust is not compared with the number in the manifest: that number is this sum, and no cap gives it.
TEST(Corpus, TheManifestLeavesTheConeToTheCutOutOfTheOpenBust) {
  ASSERT_EQ(test::corpus().count(kOpenBust), 1u);
  const json& entry = test::corpus().at(kOpenBust);
  const auto repaired = read_and_repair(entry);
  ASSERT_TRUE(repaired.ok()) << repaired.error().message;
  const TriangleMesh& mesh = repaired->placed;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& v : mesh.vertices) mean += v / static_cast<double>(mesh.vertices.size());
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += (mesh.vertices[a] - mean).dot((mesh.vertices[b] - mean).cross(mesh.vertices[c] - mean)) / 6;
  }
  EXPECT_NEAR(sum / expected_volume(entry), 1, 1e-9);
  EXPECT_GT(volume_with_flat_cap(mesh) / sum, 1.05);
}

TEST(Corpus, TheSameBodyInTwoFormatsHasTheSameVolume) {
  ASSERT_EQ(test::corpus().count("spot_low"), 1u);
  const auto obj = read_and_repair(test::corpus().at("spot_low"));
  ASSERT_TRUE(obj.ok());
  for (const char* other : {"ply_big_endian_f64", "stl_named_obj"}) {
    const auto twin = read_and_repair(test::corpus().at(other));
    ASSERT_TRUE(twin.ok()) << other << ": " << twin.error().message;
    EXPECT_NEAR(twin->outcome.solid.volume_mm3() / obj->outcome.solid.volume_mm3(), 1, 1e-4) << other;
  }
}

}  // namespace
}  // namespace skinframe
