// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/sample_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "tests/worker/fixture/skin_of.h"
#include "tests/worker/skin/bodies.h"
#include "worker/frame/convex_region.h"
#include "worker/skin/mend_edges.h"

namespace skinframe {
namespace {

using test::skin_of;

FrameOptions options_for_pa() {
  FrameOptions options;
  options.plate.tensile_modulus_mpa = 1586;
  return options;
}

SampledFrame frame_of(const Skin& skin, const FrameOptions& options) {
  RunContext context;
  auto sampled = sample_frame(skin, options, context);
  EXPECT_TRUE(sampled.ok()) << sampled.error().message;
  return std::move(sampled.value());
}

TriangleMesh skin_mesh(const Frame& frame) {
  return {{frame.nodes_mm.begin(), frame.nodes_mm.begin() + frame.skin_node_count}, frame.skin_triangles};
}

int components(const Frame& frame) {
  std::vector<int> parent(frame.nodes_mm.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i];
    return i;
  };
  for (const Strut& s : frame.struts) parent[find(s.a)] = find(s.b);
  int roots = 0;
  for (std::size_t i = 0; i < parent.size(); ++i) roots += parent[i] == static_cast<int>(i);
  return roots;
}

void expect_invariants(const SampledFrame& sampled, const Skin& skin, double radius) {
  const Frame& frame = sampled.frame;
  std::set<std::pair<int, int>> pairs, skin_pairs, triangle_edges;
  for (const Strut& s : frame.struts) {
    ASSERT_NE(s.a, s.b);
    ASSERT_GE(std::min(s.a, s.b), 0);
    ASSERT_LT(std::max(s.a, s.b), static_cast<int>(frame.nodes_mm.size()));
    EXPECT_TRUE(pairs.insert(std::minmax(s.a, s.b)).second) << "two struts join " << s.a << " and " << s.b;
    if (s.is_skin) skin_pairs.insert(std::minmax(s.a, s.b));
  }
  for (const auto& t : frame.skin_triangles) {
    for (int k = 0; k < 3; ++k) triangle_edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  }
  EXPECT_EQ(skin_pairs, triangle_edges);
  EXPECT_EQ(count_bad_edges(skin_mesh(frame)), 0);
  EXPECT_GT(signed_volume(skin_mesh(frame)), 0.0);
  EXPECT_EQ(components(frame), 1);
  for (int i = 0; i < frame.skin_node_count; ++i) {
    EXPECT_NEAR(skin.field.at(frame.nodes_mm[i]), -skin.thickness_mm, 0.3) << "skin node " << i;
  }
  EXPECT_TRUE(struts_inside(frame, std::vector<double>(frame.struts.size(), radius), skin));
  EXPECT_GE(sampled.contact_nodes.size(), 3u);
}

TEST(SampleFrame, TorusKeepsItsHole) {
  const Skin skin = skin_of(bodies::torus(26, 10));
  const SampledFrame sampled = frame_of(skin, options_for_pa());
  expect_invariants(sampled, skin, 0.5);
  EXPECT_EQ(bodies::euler_characteristic(skin_mesh(sampled.frame)), 0);
  EXPECT_EQ(sampled.skin_nodes_sampled, sampled.skin_nodes_requested);
  EXPECT_GE(sampled.frame.skin_node_count, sampled.skin_nodes_sampled);
  EXPECT_GT(sampled.angles.mean, 45.0);
  EXPECT_GT(sampled.frame.nodes_mm.size(), static_cast<std::size_t>(sampled.frame.skin_node_count));
  EXPECT_TRUE(sampled.warnings.empty());
}

TEST(SampleFrame, SphereHasExactlyTheNodesAskedFor) {
  const Skin skin = skin_of(bodies::sphere(18));
  for (int n : {12, 57, 300}) {
    FrameOptions options = options_for_pa();
    options.skin_nodes = n;
    options.internal_nodes = 10;
    const SampledFrame sampled = frame_of(skin, options);
    expect_invariants(sampled, skin, 0.5);
    EXPECT_EQ(sampled.skin_nodes_sampled, n);
    EXPECT_EQ(sampled.frame.skin_triangles.size(), 2u * sampled.frame.skin_node_count - 4u);
    EXPECT_EQ(bodies::euler_characteristic(skin_mesh(sampled.frame)), 2);
  }
}

TEST(SampleFrame, EdgesOfASphereAreEvenAndItsTrianglesRound) {
  const Skin skin = skin_of(bodies::sphere(25));
  FrameOptions options = options_for_pa();
  options.skin_nodes = 200;
  const SampledFrame sampled = frame_of(skin, options);
  double shortest = 1e9, longest = 0.0, longest_of_all = 0.0;
  for (const Strut& s : sampled.frame.struts) {
    if (!s.is_skin) continue;
    const double length = sampled.frame.length_mm(s);
    longest_of_all = std::max(longest_of_all, length);
    if (sampled.frame.nodes_mm[s.a].z() < 10.0) continue;  // near the nodes pinned to the contact
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  EXPECT_LT(longest / shortest, 2.2);
  const double sag = longest_of_all * longest_of_all / (8.0 * 24.0);  // of a chord of M1, whose radius is 24
  EXPECT_NEAR(sampled.worst_inward_chord_mm, sag, 0.15 * sag);
}

TEST(SampleFrame, BoxStandsOnItsWholeBase) {
  const Skin skin = skin_of(bodies::box(60, 40, 50));
  const SampledFrame sampled = frame_of(skin, options_for_pa());
  expect_invariants(sampled, skin, 0.5);
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (int i : sampled.contact_nodes) {
    const Eigen::Vector3d& p = sampled.frame.nodes_mm[i];
    EXPECT_LE(p.z(), 2.1);
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  // M1's base is 58 x 38: its corners are kept.
  EXPECT_NEAR(low.x(), 1.0, 0.5);
  EXPECT_NEAR(low.y(), 1.0, 0.5);
  EXPECT_NEAR(high.x(), 59.0, 0.5);
  EXPECT_NEAR(high.y(), 39.0, 0.5);
}

TEST(SampleFrame, SphereOnItsPoleStandsOnThreeNodesNotInLine) {
  const Skin skin = skin_of(bodies::sphere(20));
  const SampledFrame sampled = frame_of(skin, options_for_pa());
  double widest = 0.0;
  for (int i : sampled.contact_nodes) {
    for (int j : sampled.contact_nodes) {
      for (int k : sampled.contact_nodes) {
        const Eigen::Vector2d u = (sampled.frame.nodes_mm[j] - sampled.frame.nodes_mm[i]).head<2>();
        const Eigen::Vector2d v = (sampled.frame.nodes_mm[k] - sampled.frame.nodes_mm[i]).head<2>();
        widest = std::max(widest, std::abs(u.x() * v.y() - u.y() * v.x()));
      }
    }
  }
  // The contact is a cap of 1 mm: radius sqrt(2 * 19 * 1) = 6.2 mm.
  EXPECT_GT(widest, 35.0);
}

// A column clamped at its base and pushed at its top: nodes gather where it bends most.
TEST(SampleFrame, NodesAreDenserWhereTheSolidIsStressed) {
  const Skin skin = skin_of(bodies::box(24, 24, 90));
  RunContext context;
  StressOptions stress_options;
  stress_options.material.modulus_mpa = 1586;
  const auto stress = map_stress(skin, {{"push", {12, 12, 90}, {20, 0, 0}, 8}}, stress_options, context);
  ASSERT_TRUE(stress.ok()) << stress.error().message;
  const auto share_below = [&](const StressMap* map) {
    FrameOptions options = options_for_pa();
    options.skin_nodes = 260;
    options.stress = map;
    const SampledFrame sampled = frame_of(skin, options);
    expect_invariants(sampled, skin, 0.5);
    double low = 0, high = 0;  // on the walls, as far from the base as from the top
    for (int i = 0; i < sampled.frame.skin_node_count; ++i) {
      const double z = sampled.frame.nodes_mm[i].z();
      low += z > 8 && z < 32;
      high += z > 58 && z < 82;
    }
    return low / (low + high);
  };
  const double even = share_below(nullptr);
  EXPECT_NEAR(even, 0.5, 0.08);  // of some 160 nodes, those on the sharp edges placed by length
  EXPECT_GT(share_below(&*stress), even + 0.02);
}

// Two blocks of 20 mm and a bridge of 1.6 mm, which is thinner than two skins: M1 has two pieces.
TriangleMesh dumbbell(int bridge_cells) {
  return bodies::blocks({30, 12, 12}, {1.6, 1.6, 1.6}, [=](int x, int y, int z) {
    if (x < 12 || x >= 12 + bridge_cells) return x < 24 + bridge_cells;
    return z == 5 && y >= 2 && y < 10;
  });
}

TEST(SampleFrame, PiecesAreJoinedThroughASolidNeck) {
  const Skin skin = skin_of(dumbbell(2));
  const SampledFrame sampled = frame_of(skin, options_for_pa());
  EXPECT_EQ(sampled.pieces, 2);
  expect_invariants(sampled, skin, 0.5);
  EXPECT_EQ(bodies::euler_characteristic(skin_mesh(sampled.frame)), 4);
}

TEST(SampleFrame, PieceThatNothingJoinsIsLeftOutWithAWarning) {
  TriangleMesh two = bodies::box(30, 30, 30);
  const TriangleMesh other = bodies::box(20, 20, 20);
  for (const auto& v : other.vertices) two.vertices.push_back(v + Eigen::Vector3d(50, 0, 0));
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  const Skin skin = skin_of(two);
  const SampledFrame sampled = frame_of(skin, options_for_pa());
  EXPECT_EQ(sampled.pieces, 1);
  EXPECT_EQ(components(sampled.frame), 1);
  ASSERT_EQ(sampled.warnings.size(), 1u);
  EXPECT_THAT(sampled.warnings[0], testing::HasSubstr("no frame"));
}

TEST(SampleFrame, SameAtAnyThreadCountAndOtherwiseBySeed) {
  const Skin skin = skin_of(bodies::sphere(14));
  RunContext one, two, other;
  two.threads = 2;
  other.seed = 2;
  const auto a = sample_frame(skin, options_for_pa(), one), b = sample_frame(skin, options_for_pa(), two),
             c = sample_frame(skin, options_for_pa(), other);
  ASSERT_TRUE(a.ok() && b.ok() && c.ok());
  EXPECT_EQ(a->frame.nodes_mm, b->frame.nodes_mm);
  EXPECT_EQ(a->frame.struts.size(), b->frame.struts.size());
  EXPECT_NE(a->frame.nodes_mm, c->frame.nodes_mm);
}

TEST(SampleFrame, RefusesWhatItCannotDoByName) {
  RunContext context;
  const Skin solid_plate = skin_of(bodies::box(40, 40, 1.8));
  EXPECT_EQ(sample_frame(solid_plate, options_for_pa(), context).error().kind, ErrorKind::kInvalidInput);
  const Skin skin = skin_of(bodies::box(20, 20, 20));
  FrameOptions options = options_for_pa();
  options.skin_nodes = kMaxSkinNodes + 1;
  const auto refused = sample_frame(skin, options, context);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, testing::HasSubstr("--skin-nodes"));
  std::stop_source source;
  source.request_stop();
  context.stop = source.get_token();
  EXPECT_EQ(sample_frame(skin, options_for_pa(), context).error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace skinframe
