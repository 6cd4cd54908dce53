// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/piece_joints.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "worker/frame/convex_region.h"
#include "worker/frame/disjoint_sets.h"
#include "worker/frame/point_tree.h"

namespace skinframe {
namespace {

constexpr int kStrutsAJoint = 4;
constexpr int kPairsTried = 4000;
constexpr int kTriedFromEachNode = 6;
constexpr double kApartInRadii = 6.0;  // the nodes of one joint

struct Joint {
  double length;
  Strut strut;
};

void shortest_first(std::vector<Joint>& joints) {
  std::sort(joints.begin(), joints.end(), [](const Joint& x, const Joint& y) {
    return std::tie(x.length, x.strut.a, x.strut.b) < std::tie(y.length, y.strut.a, y.strut.b);
  });
}

bool fits(const Frame& frame, const Strut& strut, double radius_mm, const Skin& skin) {
  return strut_excess_mm(frame, strut, radius_mm, skin) <= inside_tolerance_mm(skin);
}

// Between two pieces: pairs of vertices (a of the first, b of the second) that a strut can join.
std::vector<Joint> pairs_between(const TriangleMesh& first, const TriangleMesh& second, double radius_mm,
                                 const Skin& skin) {
  // Both as skin nodes of one frame, which is what strut_excess_mm() asks about.
  Frame frame;
  frame.nodes_mm = first.vertices;
  frame.nodes_mm.insert(frame.nodes_mm.end(), second.vertices.begin(), second.vertices.end());
  frame.skin_node_count = static_cast<int>(frame.nodes_mm.size());
  const int offset = static_cast<int>(first.vertices.size());

  const PointTree tree(first.vertices);
  std::vector<Joint> candidates;
  for (int i = offset; i < frame.skin_node_count; ++i) {
    const Strut strut{tree.nearest(frame.nodes_mm[i]), i, false};
    candidates.push_back({frame.length_mm(strut), strut});
  }
  shortest_first(candidates);
  if (candidates.size() > kPairsTried) candidates.resize(kPairsTried);
  std::vector<Joint> joints;
  for (const Joint& joint : candidates) {
    if (static_cast<int>(joints.size()) == kStrutsAJoint) break;
    const bool apart = std::all_of(joints.begin(), joints.end(), [&](const Joint& other) {
      const double a = (frame.nodes_mm[joint.strut.a] - frame.nodes_mm[other.strut.a]).norm();
      const double b = (frame.nodes_mm[joint.strut.b] - frame.nodes_mm[other.strut.b]).norm();
      return std::min(a, b) >= kApartInRadii * radius_mm;
    });
    if (!apart || !fits(frame, joint.strut, radius_mm, skin)) continue;
    joints.push_back({joint.length, {joint.strut.a, joint.strut.b - offset, false}});
  }
  return joints;
}

// The struts that could join two pieces, shortest first.
std::vector<Joint> possible_joints(const Frame& frame, const std::vector<int>& piece_of, int pieces,
                                   double radius_mm, const Skin& skin) {
  std::vector<Joint> joints;
  for (int piece = 0; piece + 1 < pieces; ++piece) {
    std::vector<Eigen::Vector3d> others;
    std::vector<int> other_nodes;
    for (int i = 0; i < frame.skin_node_count; ++i) {
      if (piece_of[i] <= piece) continue;
      others.push_back(frame.nodes_mm[i]);
      other_nodes.push_back(i);
    }
    const PointTree tree(std::move(others));
    for (int i = 0; i < frame.skin_node_count; ++i) {
      if (piece_of[i] != piece) continue;
      for (int k : tree.nearest(frame.nodes_mm[i], kTriedFromEachNode)) {
        const Strut strut{i, other_nodes[k], false};
        if (fits(frame, strut, radius_mm, skin)) joints.push_back({frame.length_mm(strut), strut});
      }
    }
  }
  shortest_first(joints);
  return joints;
}

}  // namespace

std::vector<std::vector<int>> joint_pins(const std::vector<const TriangleMesh*>& pieces, double radius_mm,
                                         const Skin& skin) {
  std::vector<std::set<int>> pins(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (std::size_t q = p + 1; q < pieces.size(); ++q) {
      for (const Joint& joint : pairs_between(*pieces[p], *pieces[q], radius_mm, skin)) {
        pins[p].insert(joint.strut.a);
        pins[q].insert(joint.strut.b);
      }
    }
  }
  std::vector<std::vector<int>> result;
  for (const auto& set : pins) result.emplace_back(set.begin(), set.end());
  return result;
}

std::vector<bool> join_pieces(Frame& frame, const std::vector<int>& piece_of, double radius_mm,
                              const Skin& skin) {
  const int pieces = 1 + *std::max_element(piece_of.begin(), piece_of.end());
  if (pieces == 1) return {true};
  DisjointSets sets(pieces);
  std::map<std::pair<int, int>, int> struts_of;  // by the two pieces
  std::set<int> used;
  for (const Joint& joint : possible_joints(frame, piece_of, pieces, radius_mm, skin)) {
    const int p = piece_of[joint.strut.a], q = piece_of[joint.strut.b];
    if (used.contains(joint.strut.a) || used.contains(joint.strut.b))
      continue;  // a joint stands on several nodes
    int& count = struts_of[std::minmax(p, q)];
    if (count >= kStrutsAJoint || (count == 0 && sets.find(p) == sets.find(q))) continue;
    frame.struts.push_back(joint.strut);
    used.insert({joint.strut.a, joint.strut.b});
    ++count;
    sets.unite(p, q);
  }
  std::vector<bool> hangs_together(pieces);
  for (int p = 0; p < pieces; ++p) hangs_together[p] = sets.find(p) == sets.find(0);
  return hangs_together;
}

}  // namespace skinframe
