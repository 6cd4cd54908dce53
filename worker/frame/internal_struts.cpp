// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/internal_struts.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "worker/frame/convex_region.h"
#include "worker/frame/point_tree.h"

namespace skinframe {
namespace {

constexpr int kEnoughStruts = 4;
constexpr int kLeastStruts = 3;
constexpr int kSearchFurther = 3;  // times `neighbours`
constexpr int kStrutsAJoint = 4;
constexpr int kTriedFromEachNode = 6;

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int i, int j) { parent_[find(i)] = find(j); }

 private:
  std::vector<int> parent_;
};

bool fits(const Frame& frame, const Strut& strut, double radius_mm, const Skin& skin) {
  return strut_excess_mm(frame, strut, radius_mm, skin) <= inside_tolerance_mm(skin);
}

// One round of taking out; false when all internal nodes may stay.
bool drop_unheld_nodes(Frame& frame) {
  const int n = static_cast<int>(frame.nodes_mm.size());
  std::vector<int> degree(n, 0);
  DisjointSets sets(n);
  for (const Strut& s : frame.struts) {
    ++degree[s.a];
    ++degree[s.b];
    sets.unite(s.a, s.b);
  }
  const int skin = sets.find(0);
  std::vector<int> place(n, -1);
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    if (i >= frame.skin_node_count && (degree[i] < kLeastStruts || sets.find(i) != skin)) continue;
    place[i] = kept;
    frame.nodes_mm[kept++] = frame.nodes_mm[i];
  }
  frame.nodes_mm.resize(kept);
  std::erase_if(frame.struts, [&](const Strut& s) { return place[s.a] < 0 || place[s.b] < 0; });
  for (Strut& s : frame.struts) s = {place[s.a], place[s.b], s.is_skin};
  return kept < n;
}

struct Joint {
  double length;
  Strut strut;
};

// The shortest struts between two sets of pieces, nearest first.
std::vector<Joint> possible_joints(const Frame& frame, const std::vector<int>& piece_of, double radius_mm,
                                   const Skin& skin) {
  std::vector<Joint> joints;
  const int pieces = 1 + *std::max_element(piece_of.begin(), piece_of.end());
  for (int piece = 0; piece < pieces; ++piece) {
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
  std::sort(joints.begin(), joints.end(), [](const Joint& x, const Joint& y) {
    return std::tie(x.length, x.strut.a, x.strut.b) < std::tie(y.length, y.strut.a, y.strut.b);
  });
  return joints;
}

}  // namespace

void add_internal_struts(Frame& frame, double radius_mm, int neighbours, const Skin& skin) {
  const int n = static_cast<int>(frame.nodes_mm.size());
  const PointTree tree(frame.nodes_mm);
  std::set<std::pair<int, int>> tried;
  for (int i = frame.skin_node_count; i < n; ++i) {
    int rank = 0, made = 0;
    for (int j : tree.nearest(frame.nodes_mm[i], 1 + kSearchFurther * neighbours)) {
      if (j == i) continue;
      if (++rank > neighbours && made >= kEnoughStruts) break;
      if (!tried.insert(std::minmax(i, j)).second) continue;
      const Strut strut{std::min(i, j), std::max(i, j), false};
      if (!fits(frame, strut, radius_mm, skin)) continue;
      frame.struts.push_back(strut);
      ++made;
    }
  }
  while (drop_unheld_nodes(frame)) {
  }
}

std::vector<bool> join_pieces(Frame& frame, const std::vector<int>& piece_of, double radius_mm,
                              const Skin& skin) {
  const int pieces = 1 + *std::max_element(piece_of.begin(), piece_of.end());
  if (pieces == 1) return {true};
  DisjointSets sets(pieces);
  std::set<std::pair<int, int>> joined;  // pairs of pieces that have struts between them
  std::vector<int> count(static_cast<std::size_t>(pieces) * pieces, 0);
  std::set<int> used;
  for (const Joint& joint : possible_joints(frame, piece_of, radius_mm, skin)) {
    const auto [p, q] = std::minmax(piece_of[joint.strut.a], piece_of[joint.strut.b]);
    const bool first = sets.find(p) != sets.find(q);
    if (!first && (!joined.contains({p, q}) || count[p * pieces + q] >= kStrutsAJoint)) continue;
    if (used.contains(joint.strut.a) || used.contains(joint.strut.b))
      continue;  // a joint stands on several nodes
    frame.struts.push_back(joint.strut);
    used.insert({joint.strut.a, joint.strut.b});
    joined.insert({p, q});
    ++count[p * pieces + q];
    sets.unite(p, q);
  }
  std::vector<bool> hangs_together(pieces);
  for (int p = 0; p < pieces; ++p) hangs_together[p] = sets.find(p) == sets.find(0);
  return hangs_together;
}

}  // namespace skinframe
