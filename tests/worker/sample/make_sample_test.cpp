// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sample/make_sample.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <set>

#include "worker/mesh/read_mesh.h"
#include "worker/mesh/write_stl.h"
#include "worker/solid/contact.h"
#include "worker/solid/repair.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const TriangleMesh& sample(const std::string& name) {
  static std::map<std::string, TriangleMesh> made;
  const auto [place, is_new] = made.try_emplace(name);
  if (is_new) {
    RunContext context;
    Result<TriangleMesh> mesh = make_sample(name, context);
    EXPECT_TRUE(mesh.ok()) << mesh.error().message;
    if (mesh.ok()) place->second = std::move(mesh).value();
  }
  return place->second;
}

Solid solid_of(const std::string& name) {
  Result<Solid> solid = Solid::make(sample(name));
  SKINFRAME_CHECK(solid.ok());
  return std::move(solid).value();
}

int euler_characteristic(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  }
  return static_cast<int>(mesh.vertices.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(mesh.triangles.size());
}

// Where a bare skin of even thickness has its centre of gravity.
Eigen::Vector3d shell_centroid(const TriangleMesh& mesh) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& p = mesh.vertices[a];
    const double own = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).norm() / 2;
    area += own;
    moment += own * (p + mesh.vertices[b] + mesh.vertices[c]) / 3;
  }
  return moment / area;
}

class EverySample : public ::testing::TestWithParam<std::string> {};

TEST_P(EverySample, IsClosedAndNeedsNoRepair) {
  RunContext context;
  const auto outcome = repair(sample(GetParam()), {}, context);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_THAT(outcome->repairs, IsEmpty());
  EXPECT_THAT(outcome->warnings, IsEmpty());
}

TEST_P(EverySample, IsAsLargeAsPromised) {
  const TriangleMesh& mesh = sample(GetParam());
  EXPECT_GE(mesh.triangles.size(), 10'000u);
  EXPECT_LE(mesh.triangles.size(), 60'000u);
  EXPECT_NEAR(bounding_box(mesh).extent().maxCoeff(), 200, 1e-4);
}

TEST_P(EverySample, StandsOnAFlatFootAtZero) {
  const Solid solid = solid_of(GetParam());
  const Contact contact = find_contact(solid);
  EXPECT_EQ(contact.plane_z_mm, 0);
  EXPECT_TRUE(contact.stands);
  EXPECT_GT(contact.margin_mm, 2);
  EXPECT_GE(contact_hull(solid.mesh(), 1e-3).size(), 3u);  // flat, not merely low
  EXPECT_NEAR((solid.box().min + solid.box().max).head<2>().norm(), 0, 1e-4);
}

TEST_P(EverySample, IsTheSameOnEveryRun) {
  RunContext context;
  const auto again = make_sample(GetParam(), context);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->vertices, sample(GetParam()).vertices);
  EXPECT_EQ(again->triangles, sample(GetParam()).triangles);
}

TEST_P(EverySample, ComesBackTheSameFromAnStl) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("skinframe-sample-" + GetParam() + "-" + std::to_string(::getpid()) + ".stl");
  ASSERT_TRUE(write_stl(sample(GetParam()), path).ok());
  RunContext context;
  const auto file = read_mesh(path, {}, context);
  std::filesystem::remove(path);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->mesh.vertices.size(), sample(GetParam()).vertices.size());
  const auto solid = Solid::make(file->mesh);
  ASSERT_TRUE(solid.ok()) << solid.error().message;
  EXPECT_NEAR(solid->volume_mm3() / solid_of(GetParam()).volume_mm3(), 1, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Sample, EverySample,
                         ::testing::Values("hanging-ball", "hanging-ball-small-base", "ring", "stool",
                                           "relief", "egg", "bracket"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Samples, TheListNamesThemAllOnce) {
  std::vector<std::string> names;
  for (const SampleInfo& info : samples()) {
    names.push_back(info.name);
    EXPECT_FALSE(info.description.empty());
    EXPECT_EQ(info.description.find('\n'), std::string::npos);
  }
  EXPECT_THAT(names, ::testing::ElementsAre("hanging-ball", "hanging-ball-small-base", "ring", "stool",
                                            "relief", "egg", "bracket"));
}

TEST(Samples, HolesThroughTheBodiesAreAsDescribed) {
  EXPECT_EQ(euler_characteristic(sample("hanging-ball")), 2);
  EXPECT_EQ(euler_characteristic(sample("hanging-ball-small-base")), 2);
  EXPECT_EQ(euler_characteristic(sample("ring")), 0);
  EXPECT_EQ(euler_characteristic(sample("stool")), -6);  // four windows between legs and rungs
  EXPECT_EQ(euler_characteristic(sample("relief")), 2);
  EXPECT_EQ(euler_characteristic(sample("egg")), 2);
  EXPECT_EQ(euler_characteristic(sample("bracket")), -4);  // three bolt holes
}

TEST(Samples, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  RunContext context;
  const auto mesh = make_sample("teapot", context);
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(mesh.error().message,
              HasSubstr("\"teapot\"; the samples are hanging-ball, hanging-ball-small-base, ring"));
}

// What figure 7 of the paper needs: the solid stands on both bases; its bare skin tips over the small one, by
// little enough for struts to bring it back.
TEST(HangingBall, TheSolidStandsOnBothBasesWithAMargin) {
  EXPECT_GT(find_contact(solid_of("hanging-ball")).margin_mm, 10);
  EXPECT_GT(find_contact(solid_of("hanging-ball-small-base")).margin_mm, 2.5);
}

TEST(HangingBall, TheBareSkinTipsOverTheSmallBaseOnly) {
  const auto margin = [](const std::string& name) {
    const TriangleMesh& mesh = sample(name);
    return signed_margin_mm(contact_hull(mesh), shell_centroid(mesh).head<2>());
  };
  EXPECT_GT(margin("hanging-ball"), 5);
  EXPECT_LT(margin("hanging-ball-small-base"), -1.0);
  EXPECT_GT(margin("hanging-ball-small-base"), -2.5);
}

TEST(HangingBall, TheBasesDifferAndNothingElse) {
  // Above the base disc the two are the same body, but for the place on the plate.
  const auto volume_above_base = [](const std::string& name) {
    TriangleMesh mesh = sample(name);
    double volume = 0;  // of the prisms between the surface above 40 mm and that plane
    for (const auto& [a, b, c] : mesh.triangles) {
      const Eigen::Vector3d &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
      if (std::min({p.z(), q.z(), r.z()}) < 40) continue;
      volume += (q - p).cross(r - p).z() / 2 * ((p.z() + q.z() + r.z()) / 3 - 40);
    }
    return volume;
  };
  EXPECT_NEAR(volume_above_base("hanging-ball") / volume_above_base("hanging-ball-small-base"), 1, 1e-3);
  EXPECT_GT(bounding_box(sample("hanging-ball")).extent().y(), 80);
  EXPECT_LT(bounding_box(sample("hanging-ball-small-base")).extent().y(), 65);
}

}  // namespace
}  // namespace skinframe
