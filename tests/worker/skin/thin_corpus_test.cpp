// SPDX-License-Identifier: GPL-3.0-or-later
// Thin parts of published meshes against rays and exact distances. Built where the corpus is (or must be,
// CI=true).
#include <gtest/gtest.h>

#include "tests/fixture/corpus.h"
#include "tests/worker/skin/thin_rays.h"
#include "worker/mesh/read_mesh.h"
#include "worker/skin/build_skin.h"
#include "worker/solid/place.h"
#include "worker/solid/repair.h"

namespace skinframe {
namespace {

struct ThinModel {
  const char* id;
  double size_mm;
};
void PrintTo(const ThinModel& model, std::ostream* out) {
  *out << model.id << " at " << model.size_mm << " mm";
}

class ThinCorpus : public testing::TestWithParam<ThinModel> {};

TEST_P(ThinCorpus, VolumeIsThatOfTheRaysWithinTwoPercent) {
  RunContext context;
  context.threads = 2;
  auto file = read_mesh(test::corpus_folder() / "good" / (std::string(GetParam().id) + ".obj"), {}, context);
  ASSERT_TRUE(file.ok()) << file.error().message;
  auto outcome =
      repair(put_on_plate(scale_to_largest_edge(std::move(file->mesh), GetParam().size_mm)), {}, context);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  const auto skin = build_skin(outcome->solid, {.thickness_mm = 1.0}, context);
  ASSERT_TRUE(skin.ok()) << skin.error().message;
  const auto rays = oracle::thin_by_rays(outcome->solid.mesh(), 1.0, 0.2);
  RecordProperty("thin_mm3", std::to_string(skin->thin.volume_mm3));
  RecordProperty("thin_by_rays_mm3", std::to_string(rays.volume_mm3));
  EXPECT_GT(rays.volume_mm3, 0);
  EXPECT_NEAR(skin->thin.volume_mm3, rays.volume_mm3, 0.02 * rays.volume_mm3);
  const double fraction = rays.volume_mm3 / outcome->solid.volume_mm3();
  EXPECT_NEAR(skin->thin.fraction, fraction, 0.02 * fraction);
}

INSTANTIATE_TEST_SUITE_P(Corpus, ThinCorpus,
                         testing::Values(ThinModel{"plane", 200}, ThinModel{"human", 200},
                                         ThinModel{"scorpion_low", 200}, ThinModel{"fish", 60}),
                         [](const auto& tested) { return std::string(tested.param.id); });

}  // namespace
}  // namespace skinframe
