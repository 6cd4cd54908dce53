// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/merge_nodes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace skinframe {
namespace {

bool moves(const FrameProblem& problem, int node) {
  return !problem.free_nodes.empty() && problem.free_nodes[node];
}

}  // namespace

std::vector<int> contractible_struts(const Design& design, double share) {
  const FrameProblem& problem = design.problem;
  const Frame& frame = problem.frame;
  std::vector<std::pair<double, int>> lengths;
  double total = 0;
  for (int j = 0; j < static_cast<int>(frame.struts.size()); ++j) {
    const Strut& strut = frame.struts[j];
    if (!moves(problem, strut.a) && !moves(problem, strut.b)) continue;
    lengths.emplace_back(frame.length_mm(strut), j);
    total += lengths.back().first;
  }
  const double least = share * total / static_cast<double>(std::max<std::size_t>(lengths.size(), 1));
  std::sort(lengths.begin(), lengths.end());
  std::vector<bool> taken(frame.nodes_mm.size(), false);
  std::vector<int> short_struts;
  for (const auto& [length, j] : lengths) {
    if (length >= least) break;
    const Strut& strut = frame.struts[j];
    if (taken[strut.a] || taken[strut.b]) continue;
    taken[strut.a] = taken[strut.b] = true;
    short_struts.push_back(j);
  }
  return short_struts;
}

std::optional<Design> contracted_design(const Design& design, const std::vector<int>& struts) {
  Design merged = design;
  Frame& frame = merged.problem.frame;
  std::vector<int> stands_for(frame.nodes_mm.size());
  for (std::size_t i = 0; i < stands_for.size(); ++i) stands_for[i] = static_cast<int>(i);
  std::vector<bool> keep(frame.struts.size(), true);
  for (int j : struts) {
    auto [stays, goes] = std::pair(frame.struts[j].a, frame.struts[j].b);
    if (!moves(design.problem, goes)) std::swap(stays, goes);
    if (!moves(design.problem, goes)) return std::nullopt;
    if (moves(design.problem, stays))
      frame.nodes_mm[stays] = (frame.nodes_mm[stays] + frame.nodes_mm[goes]) / 2;
    stands_for[goes] = stays;
    keep[j] = false;
  }
  std::map<std::pair<int, int>, int> joined;
  for (int j = 0; j < static_cast<int>(frame.struts.size()); ++j) {
    if (!keep[j]) continue;
    Strut& strut = frame.struts[j];
    strut.a = stands_for[strut.a];
    strut.b = stands_for[strut.b];
    if (strut.a == strut.b) {
      keep[j] = false;
      continue;
    }
    const auto [first, fresh] = joined.try_emplace(std::minmax(strut.a, strut.b), j);
    if (fresh) continue;
    int stays = first->second, goes = j;
    if (strut.is_skin && !frame.struts[stays].is_skin) std::swap(stays, goes);
    merged.areas_mm2[stays] += merged.areas_mm2[goes];
    keep[goes] = false;
    first->second = stays;
  }
  return reduced_design(merged, keep);
}

}  // namespace skinframe
