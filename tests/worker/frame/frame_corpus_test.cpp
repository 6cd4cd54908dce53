// SPDX-License-Identifier: GPL-3.0-or-later
// The frame of every good model of the corpus that has an inside: topology, connection, angles, and struts
// that stay in the body. Built where the corpus is.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "tests/fixture/corpus.h"
#include "tests/worker/skin/bodies.h"
#include "worker/frame/convex_region.h"
#include "worker/frame/sample_frame.h"
#include "worker/frame/vertex_graph.h"
#include "worker/mesh/read_mesh.h"
#include "worker/skin/mend_edges.h"
#include "worker/solid/place.h"
#include "worker/solid/repair.h"

namespace skinframe {
namespace {

constexpr double kTestedSizeMm = 100;

std::vector<std::string> good_ids() {
  std::vector<std::string> ids;
  for (const auto& [id, entry] : test::corpus())
    if (entry["file"].get<std::string>().starts_with("good/") && !entry.value("thin_everywhere", false))
      ids.push_back(id);
  return ids;
}

// The manifest calls no model smooth, but its tags name what keeps a body from it: sides of a plate no wider
// than it is thick, limbs and the walls between a skull's cavities have slender triangles.
bool is_smooth(const std::string& id) {
  for (const auto& tag : test::corpus().at(id)["tags"])
    for (const char* word : {"thin limbs", "flat plate", "cavities"})
      if (tag.get<std::string>().find(word) != std::string::npos) return false;
  return true;
}
constexpr double kLeastMeanAngleSmooth = 40.0, kLeastMeanAngle = 28.0;  // degrees
// In grooves narrower than the triangles some chords cannot be divided: so many at most, and reported.
const std::map<std::string, int> kOutsideAtMost = {
    {"penguin", 8}, {"plane", 8}, {"scorpion_low", 40}, {"skull_low", 8}};

Result<Skin> skin_of(const std::string& id) {
  RunContext context;
  auto file =
      read_mesh(test::corpus_folder() / test::corpus().at(id)["file"].get<std::string>(), {}, context);
  if (!file) return file.error();
  auto outcome =
      repair(put_on_plate(scale_to_largest_edge(std::move(file->mesh), kTestedSizeMm)), {}, context);
  if (!outcome) return outcome.error();
  return build_skin(outcome->solid, SkinOptions{}, context);
}

std::multiset<int> euler_characteristics(const TriangleMesh& mesh) {
  std::multiset<int> found;
  for (const TriangleMesh& piece : split_pieces(mesh)) found.insert(bodies::euler_characteristic(piece));
  return found;
}

std::set<int> reached_from_contact(const SampledFrame& sampled) {
  std::vector<std::vector<int>> beside(sampled.frame.nodes_mm.size());
  for (const Strut& s : sampled.frame.struts) {
    beside[s.a].push_back(s.b);
    beside[s.b].push_back(s.a);
  }
  std::set<int> reached{sampled.contact_nodes.front()};
  std::vector<int> stack(reached.begin(), reached.end());
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    for (const int next : beside[node])
      if (reached.insert(next).second) stack.push_back(next);
  }
  return reached;
}

class FrameOfModel : public testing::TestWithParam<std::string> {};

TEST_P(FrameOfModel, IsWholeConnectedAndInTheBody) {
  const auto skin = skin_of(GetParam());
  ASSERT_TRUE(skin.ok()) << skin.error().message;
  RunContext context;
  FrameOptions options;
  options.plate.tensile_modulus_mpa = 1586;
  const auto sampled = sample_frame(*skin, options, context);
  if (skin->is_thin_everywhere()) {  // at this size: printed solid
    EXPECT_FALSE(sampled.ok());
    return;
  }
  ASSERT_TRUE(sampled.ok()) << sampled.error().message;
  const Frame& frame = sampled->frame;
  const TriangleMesh triangulation{{frame.nodes_mm.begin(), frame.nodes_mm.begin() + frame.skin_node_count},
                                   frame.skin_triangles};
  EXPECT_EQ(count_bad_edges(triangulation), 0);
  EXPECT_GT(signed_volume(triangulation), 0.0);
  const auto of_frame = euler_characteristics(triangulation),
             of_m1 = euler_characteristics(skin->inner_surface);
  EXPECT_EQ(of_frame.size(), static_cast<std::size_t>(sampled->pieces));
  EXPECT_TRUE(std::includes(of_m1.begin(), of_m1.end(), of_frame.begin(), of_frame.end()))
      << "a piece has another topology than M1";
  EXPECT_EQ(reached_from_contact(*sampled).size(), frame.nodes_mm.size());

  RecordProperty("mean_angle", std::to_string(sampled->angles.mean));
  RecordProperty("first_percentile_angle", std::to_string(sampled->angles.first_percentile));
  EXPECT_GE(sampled->angles.mean, is_smooth(GetParam()) ? kLeastMeanAngleSmooth : kLeastMeanAngle);

  int outside = 0;
  for (const Strut& s : frame.struts) {
    const Eigen::Vector3d &a = frame.nodes_mm[s.a], &b = frame.nodes_mm[s.b];
    double furthest = -1e9;
    for (int k = 0; k <= 32; ++k) furthest = std::max(furthest, skin->field.at(a + k / 32.0 * (b - a)));
    outside += furthest > skin->voxel_mm;
    if (!s.is_skin) {
      EXPECT_LT(furthest, 0.0) << "internal strut " << s.a << "-" << s.b;
    }
  }
  RecordProperty("struts_outside", outside);
  EXPECT_LE(outside, sampled->skin_struts_outside);
  const auto allowed = kOutsideAtMost.find(GetParam());
  EXPECT_LE(outside, allowed == kOutsideAtMost.end() ? 0 : allowed->second);
}

INSTANTIATE_TEST_SUITE_P(Corpus, FrameOfModel, testing::ValuesIn(good_ids()),
                         [](const auto& tested) { return tested.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(FrameOfModel);

TEST(Corpus, HasGoodModels) { EXPECT_GE(good_ids().size(), 15u) << test::corpus_folder(); }

}  // namespace
}  // namespace skinframe
