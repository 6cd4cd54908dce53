// SPDX-License-Identifier: GPL-3.0-or-later
// Sharp edges of M1 and the ring about its base contact have nodes, and struts run along them.
#include "worker/frame/sharp_chains.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/worker/skin/bodies.h"
#include "worker/frame/sample_frame.h"
#include "worker/sample/make_sample.h"
#include "worker/skin/mend_edges.h"
#include "worker/solid/place.h"

namespace skinframe {
namespace {

Skin skin_of(const TriangleMesh& body) {
  RunContext context;
  auto skin = build_skin(body, SkinOptions{}, context);
  EXPECT_TRUE(skin.ok()) << skin.error().message;
  return std::move(skin.value());
}

SampledFrame frame_of(const Skin& skin, std::optional<int> nodes = {}) {
  RunContext context;
  FrameOptions options;
  options.plate.tensile_modulus_mpa = 1586;
  options.skin_nodes = nodes;
  auto sampled = sample_frame(skin, options, context);
  EXPECT_TRUE(sampled.ok()) << sampled.error().message;
  return std::move(sampled.value());
}

TriangleMesh skin_mesh(const Frame& frame) {
  return {{frame.nodes_mm.begin(), frame.nodes_mm.begin() + frame.skin_node_count}, frame.skin_triangles};
}

std::set<std::pair<int, int>> edges_of(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  return edges;
}

TEST(SharpChains, EveryEdgeOfABoxIsFollowedFromCornerToCorner) {
  const Skin skin = skin_of(bodies::box(60, 40, 50));
  for (const int nodes : {60, 150, 400}) {
    const SampledFrame sampled = frame_of(skin, nodes);
    const Frame& frame = sampled.frame;
    EXPECT_EQ(sampled.skin_nodes_sampled, nodes);
    EXPECT_EQ(count_bad_edges(skin_mesh(frame)), 0);
    EXPECT_EQ(bodies::euler_characteristic(skin_mesh(frame)), 2);
    EXPECT_GT(sampled.angles.mean, 40.0);
    const auto edges = edges_of(skin_mesh(frame));
    double length = 0;
    for (const auto& [a, b] : sampled.sharp_chords) {
      EXPECT_EQ(edges.count(std::minmax(a, b)), 1u) << "no strut along the edge from " << a << " to " << b;
      length += (frame.nodes_mm[a] - frame.nodes_mm[b]).norm();
    }
    EXPECT_NEAR(length, 4 * (58 + 38 + 48), 1e-3);
    for (const double x : {1.0, 59.0})
      for (const double y : {1.0, 39.0})
        for (const double z : {1.0, 49.0}) {
          double nearest = 1e9;
          for (int i = 0; i < frame.skin_node_count; ++i)
            nearest = std::min(nearest, (frame.nodes_mm[i] - Eigen::Vector3d(x, y, z)).norm());
          EXPECT_LT(nearest, 1e-6) << "corner " << x << " " << y << " " << z;
        }
  }
}

TEST(SharpChains, RoundBodiesHaveNoneAndKeepTheirTriangles) {
  const SampledFrame sampled = frame_of(skin_of(bodies::torus(26, 10)));
  EXPECT_TRUE(sampled.sharp_chords.empty());
  EXPECT_GT(sampled.angles.mean, 45.0);
}

// A closed rim stays closed: as many chords as nodes on it.
TEST(SharpChains, ChordsAlongEdgesFormPathsThroughEveryNodeOnThem) {
  const SampledFrame sampled = frame_of(
      skin_of(bodies::blocks({2, 2, 1}, {24, 24, 24}, [](int x, int y, int) { return x == 0 || y == 0; })));
  std::map<int, int> degree;
  for (const auto& [a, b] : sampled.sharp_chords) {
    ++degree[a];
    ++degree[b];
  }
  EXPECT_GT(degree.size(), 20u);
  int ends = 0;
  for (const auto& [node, count] : degree) {
    EXPECT_LE(count, 3);
    ends += count == 1;  // only where the offset turns round about the inward edge
  }
  EXPECT_LE(ends, 4);
  EXPECT_EQ(count_bad_edges(skin_mesh(sampled.frame)), 0);
}

class ContactRing : public testing::TestWithParam<const char*> {};

TEST_P(ContactRing, HasANodeNearEachOfItsPoints) {
  RunContext context;
  auto body = make_sample(GetParam(), context);
  ASSERT_TRUE(body.ok());
  const Skin skin = skin_of(put_on_plate(scale_to_largest_edge(std::move(body.value()), 110)));
  const SampledFrame sampled = frame_of(skin);
  ASSERT_GE(sampled.contact_nodes.size(), 3u);
  // The ring: M1 between the contact's height and half a millimetre below.
  const double height = skin.plate_z_mm + skin.thickness_mm + 1.0;
  int ring = 0;
  for (const Eigen::Vector3d& p : skin.inner_surface.vertices) {
    if (p.z() > height || p.z() < height - 0.5) continue;
    ++ring;
    double nearest = 1e9;
    for (const int i : sampled.contact_nodes)
      nearest = std::min(nearest, (sampled.frame.nodes_mm[i] - p).norm());
    EXPECT_LT(nearest, 1.2 * sampled.mean_skin_edge_mm) << p.transpose();
  }
  EXPECT_GT(ring, 20);
  EXPECT_GT(sampled.angles.mean, 40.0);
}

INSTANTIATE_TEST_SUITE_P(Samples, ContactRing, testing::Values("bracket", "stool"));

}  // namespace
}  // namespace skinframe
