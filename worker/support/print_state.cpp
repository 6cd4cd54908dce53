// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/print_state.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "worker/frame/point_tree.h"
#include "worker/mechanics/equilibrium.h"
#include "worker/support/plan_supports.h"

namespace skinframe {
namespace {

using On = SupportNode::On;
constexpr int kTies = 3;

double worst_deformation_mm(const FrameProblem& print, const std::vector<double>& radii_mm) {
  const CaseResponse response = solve_equilibrium(print, areas_of(radii_mm)).front();
  double worst = 0;
  for (const Strut& strut : print.frame.struts) {
    const auto &a = print.frame.nodes_mm[strut.a], &b = print.frame.nodes_mm[strut.b];
    if (angle_from_vertical(a, b) > kLevelDegrees * std::numbers::pi / 180) continue;
    worst = std::max(
        worst, std::abs(response.displacements_mm[strut.a].z() - response.displacements_mm[strut.b].z()));
  }
  return worst;
}

}  // namespace

FrameProblem print_problem(const FrameProblem& problem, const std::vector<double>& radii_mm,
                           const SupportPlan& plan, double tie_radius_mm, std::vector<double>* all_radii_mm) {
  const Frame& frame = problem.frame;
  const int own = static_cast<int>(frame.nodes_mm.size());
  FrameProblem print;
  print.element = problem.element;
  print.material = problem.material;
  print.frame.nodes_mm = frame.nodes_mm;
  print.frame.skin_node_count = frame.skin_node_count;
  for (const SupportNode& node : plan.nodes) print.frame.nodes_mm.push_back(node.at_mm);

  std::set<std::pair<int, int>> joined;
  all_radii_mm->clear();
  const auto join = [&](int a, int b, double radius_mm) {
    if (a == b || !joined.insert({std::min(a, b), std::max(a, b)}).second) return;
    print.frame.struts.push_back({a, b, false});
    print.bounds.push_back({0, std::max(radius_mm, 1.0)});
    all_radii_mm->push_back(radius_mm);
  };
  const auto divided = divided_struts(frame, plan);
  for (std::size_t j = 0; j < divided.size(); ++j)
    for (std::size_t k = 0; k + 1 < divided[j].size(); ++k)
      join(divided[j][k], divided[j][k + 1], radii_mm[j]);
  for (const SupportStrut& strut : plan.struts) join(strut.upper, strut.lower, strut.radius_mm);
  const PointTree skin(
      std::vector<Eigen::Vector3d>(frame.nodes_mm.begin(), frame.nodes_mm.begin() + frame.skin_node_count));
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)
    if (plan.nodes[i].on == On::kSkin || plan.nodes[i].on == On::kRoof)
      for (const int near : skin.nearest(plan.nodes[i].at_mm, kTies))
        join(own + static_cast<int>(i), near, tie_radius_mm);

  print.fixed.assign(print.frame.nodes_mm.size(), {false, false, false});
  for (int i = 0; i < own; ++i)
    if (problem.fixed[i][2]) print.fixed[i] = {true, true, true};
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)
    if (plan.nodes[i].on == On::kPlate) print.fixed[own + i] = {true, true, true};
  if (!problem.skin_weight_n.empty()) {
    print.skin_weight_n = problem.skin_weight_n;
    print.skin_weight_n.resize(print.frame.nodes_mm.size(), 0.0);
  }
  print.load_cases = {
      {"print", true, std::vector<Eigen::Vector3d>(print.frame.nodes_mm.size(), Eigen::Vector3d::Zero())}};
  return print;
}

PrintState size_supports(const FrameProblem& problem, const std::vector<double>& radii_mm,
                         double tie_radius_mm, SupportPlan& plan) {
  PrintState state;
  state.limit_mm = problem.displacement_limit_mm;
  for (int growths = 0;; ++growths) {
    std::vector<double> all_radii_mm;
    const FrameProblem print = print_problem(problem, radii_mm, plan, tie_radius_mm, &all_radii_mm);
    state.worst_deformation_mm = worst_deformation_mm(print, all_radii_mm);
    if (state.holds() || growths == kMostGrowths || plan.struts.empty()) return state;
    for (SupportStrut& strut : plan.struts) strut.radius_mm *= kGrowth;
  }
}

}  // namespace skinframe
