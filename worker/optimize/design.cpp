// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/design.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace skinframe {
namespace {

// Nodes that must stay whatever happens to their struts.
std::vector<bool> lasting_nodes(const FrameProblem& problem) {
  std::vector<bool> lasting = loaded_nodes(problem);
  const std::vector<bool> of_skin = skin_nodes(problem.frame);
  for (std::size_t i = 0; i < lasting.size(); ++i)
    if (of_skin[i]) lasting[i] = true;
  return lasting;
}

// Those, and supports: struts may end there. An axis that is held at every node (of a plane frame) supports
// none.
std::vector<bool> anchored_nodes(const FrameProblem& problem) {
  std::vector<bool> anchored = lasting_nodes(problem);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::all_of(problem.fixed.begin(), problem.fixed.end(), [&](const auto& axes) { return axes[axis]; }))
      continue;
    for (std::size_t i = 0; i < anchored.size(); ++i)
      if (problem.fixed[i][axis]) anchored[i] = true;
  }
  return anchored;
}

std::vector<std::vector<int>> struts_at_nodes(const Frame& frame, const std::vector<bool>& keep) {
  std::vector<std::vector<int>> at(frame.nodes_mm.size());
  for (std::size_t j = 0; j < frame.struts.size(); ++j)
    if (keep[j]) {
      at[frame.struts[j].a].push_back(static_cast<int>(j));
      at[frame.struts[j].b].push_back(static_cast<int>(j));
    }
  return at;
}

void drop_unreached(const Frame& frame, const std::vector<bool>& anchored, std::vector<bool>& keep) {
  const auto at = struts_at_nodes(frame, keep);
  std::vector<bool> reached = anchored;
  std::vector<int> front;
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (reached[i]) front.push_back(static_cast<int>(i));
  while (!front.empty()) {
    const int node = front.back();
    front.pop_back();
    for (int j : at[node])
      for (int other : {frame.struts[j].a, frame.struts[j].b})
        if (!reached[other]) {
          reached[other] = true;
          front.push_back(other);
        }
  }
  for (std::size_t j = 0; j < keep.size(); ++j)
    if (!reached[frame.struts[j].a]) keep[j] = false;
}

void drop_dangling(const Frame& frame, const std::vector<bool>& anchored, std::vector<bool>& keep) {
  const auto at = struts_at_nodes(frame, keep);
  std::vector<int> degree(at.size()), front;
  for (std::size_t i = 0; i < at.size(); ++i) {
    degree[i] = static_cast<int>(at[i].size());
    if (degree[i] == 1 && !anchored[i]) front.push_back(static_cast<int>(i));
  }
  while (!front.empty()) {
    const int node = front.back();
    front.pop_back();
    for (int j : at[node]) {
      if (!keep[j]) continue;
      keep[j] = false;
      const int other = frame.struts[j].a == node ? frame.struts[j].b : frame.struts[j].a;
      --degree[node];
      if (--degree[other] == 1 && !anchored[other]) front.push_back(other);
    }
  }
}

}  // namespace

Design initial_design(const FrameProblem& problem) {
  Design design;
  design.problem = problem;
  design.node_origin.resize(problem.frame.nodes_mm.size());
  design.strut_origin.resize(problem.frame.struts.size());
  std::iota(design.node_origin.begin(), design.node_origin.end(), 0);
  std::iota(design.strut_origin.begin(), design.strut_origin.end(), 0);
  return design;
}

std::vector<bool> removable_struts(const FrameProblem& problem) {
  std::vector<bool> removable;
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j)
    removable.push_back(!problem.frame.struts[j].is_skin || problem.bounds[j].min_mm == 0);
  return removable;
}

Design reduced_design(const Design& design, std::vector<bool> keep) {
  const FrameProblem& from = design.problem;
  const std::vector<bool> anchored = anchored_nodes(from);
  drop_unreached(from.frame, anchored, keep);
  drop_dangling(from.frame, anchored, keep);

  std::vector<bool> stays = lasting_nodes(from);
  for (std::size_t j = 0; j < keep.size(); ++j)
    if (keep[j]) stays[from.frame.struts[j].a] = stays[from.frame.struts[j].b] = true;

  Design to;
  FrameProblem& p = to.problem;
  p.element = from.element;
  p.material = from.material;
  p.displacement_limit_mm = from.displacement_limit_mm;
  p.balance = from.balance;
  p.skin_mass = from.skin_mass;
  for (const LoadCase& load : from.load_cases) p.load_cases.push_back({load.name, load.gravity, {}});
  std::vector<int> new_number(stays.size(), -1);
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (!stays[i]) continue;
    new_number[i] = static_cast<int>(p.frame.nodes_mm.size());
    p.frame.nodes_mm.push_back(from.frame.nodes_mm[i]);
    if (static_cast<int>(i) < from.frame.skin_node_count) ++p.frame.skin_node_count;
    p.fixed.push_back(from.fixed[i]);
    if (!from.skin_weight_n.empty()) p.skin_weight_n.push_back(from.skin_weight_n[i]);
    if (!from.free_nodes.empty()) p.free_nodes.push_back(from.free_nodes[i]);
    for (std::size_t k = 0; k < p.load_cases.size(); ++k)
      p.load_cases[k].force_n.push_back(from.load_cases[k].force_n[i]);
    to.node_origin.push_back(design.node_origin[i]);
  }
  for (std::size_t j = 0; j < keep.size(); ++j) {
    if (!keep[j]) continue;
    const Strut& strut = from.frame.struts[j];
    p.frame.struts.push_back({new_number[strut.a], new_number[strut.b], strut.is_skin});
    p.bounds.push_back(from.bounds[j]);
    to.strut_origin.push_back(design.strut_origin[j]);
    if (!design.areas_mm2.empty()) to.areas_mm2.push_back(design.areas_mm2[j]);
  }
  to.warm = renumbered(design.warm, new_number, static_cast<int>(p.frame.nodes_mm.size()));
  for (const auto& t : from.frame.skin_triangles) {
    const std::array<int, 3> corners{new_number[t[0]], new_number[t[1]], new_number[t[2]]};
    if (corners[0] >= 0 && corners[1] >= 0 && corners[2] >= 0) p.frame.skin_triangles.push_back(corners);
  }
  return to;
}

}  // namespace skinframe
