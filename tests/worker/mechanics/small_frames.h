// SPDX-License-Identifier: GPL-3.0-or-later
// Frames small enough for algebra.
#pragma once

#include "worker/mechanics/frame_problem.h"

namespace skinframe::testing {

// Nodes and struts with bounds 0.5..5 mm, P-1's plastic, no support, no load case.
inline FrameProblem bare_problem(std::vector<Eigen::Vector3d> nodes_mm,
                                 const std::vector<std::pair<int, int>>& struts) {
  FrameProblem problem;
  problem.material = {"pa", 1586, 1387, std::nullopt, std::nullopt, std::nullopt, 1.15};
  problem.frame.nodes_mm = std::move(nodes_mm);
  for (const auto& [a, b] : struts) {
    problem.frame.struts.push_back({a, b, false});
    problem.bounds.push_back({0.5, 5.0});
  }
  problem.fixed.assign(problem.frame.nodes_mm.size(), {false, false, false});
  return problem;
}

inline LoadCase load_at(const FrameProblem& problem, int node, const Eigen::Vector3d& force_n,
                        bool gravity = false) {
  LoadCase load{"load", gravity,
                std::vector<Eigen::Vector3d>(problem.frame.nodes_mm.size(), Eigen::Vector3d::Zero())};
  load.force_n[node] = force_n;
  return load;
}

// A chain of equal struts along x from a fixed end.
inline FrameProblem chain(int struts, double length_mm) {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i <= struts; ++i) nodes.emplace_back(length_mm * i / struts, 0, 0);
  for (int i = 0; i < struts; ++i) pairs.emplace_back(i, i + 1);
  FrameProblem problem = bare_problem(nodes, pairs);
  problem.fixed[0] = {true, true, true};
  return problem;
}

// Two struts from fixed points (-w, 0, h) and (w, 0, h) down to the origin, which is free in x and z.
inline FrameProblem two_strut_truss(double w, double h) {
  FrameProblem problem = bare_problem({{-w, 0, h}, {w, 0, h}, {0, 0, 0}}, {{0, 2}, {1, 2}});
  problem.element = ElementModel::kAxial;
  problem.fixed[0] = problem.fixed[1] = {true, true, true};
  problem.fixed[2] = {false, true, false};
  return problem;
}

}  // namespace skinframe::testing
