// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/internal_struts.h"

#include <algorithm>
#include <set>

#include "worker/frame/convex_region.h"
#include "worker/frame/disjoint_sets.h"
#include "worker/frame/point_tree.h"

namespace skinframe {
namespace {

constexpr int kEnoughStruts = 4;
constexpr int kLeastStruts = 3;
constexpr int kSearchFurther = 3;  // times `neighbours`

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
      if (strut_excess_mm(frame, strut, radius_mm, skin) > inside_tolerance_mm(skin)) continue;
      frame.struts.push_back(strut);
      ++made;
    }
  }
  while (drop_unheld_nodes(frame)) {
  }
}

}  // namespace skinframe
