// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/frames/loads.h"

#include <utility>

#include "worker/mechanics/evaluation.h"

namespace skinframe::bench {
namespace {

using Eigen::Vector3d;

constexpr double kForceN = 20, kTopForceN = 5;
constexpr double kPatchMm = 10;
constexpr int kMostDoublings = 8;

const std::vector<std::pair<std::string, LoadKind>> kKinds{{"self", LoadKind::kSelf},
                                                           {"side", LoadKind::kSide},
                                                           {"three", LoadKind::kThree},
                                                           {"top5", LoadKind::kTop5}};

// The force in equal shares on the skin nodes near the highest.
LoadCase top_load(const FrameProblem& problem, const std::string& name, const Vector3d& force_n) {
  const auto& nodes = problem.frame.nodes_mm;
  const std::vector<bool> of_skin = skin_nodes(problem.frame);
  std::size_t top = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (of_skin[i] && (!of_skin[top] || nodes[i].z() > nodes[top].z())) top = i;
  std::vector<std::size_t> patch;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (of_skin[i] && (nodes[i] - nodes[top]).norm() <= kPatchMm) patch.push_back(i);
  LoadCase load{name, true, std::vector<Vector3d>(nodes.size(), Vector3d::Zero())};
  for (std::size_t i : patch) load.force_n[i] = force_n / static_cast<double>(patch.size());
  return load;
}

double demand_at_lower_bounds(const FrameProblem& problem) {
  std::vector<double> areas;
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j)
    areas.push_back(area_bounds(problem, static_cast<int>(j)).lower_mm2);
  return utilisation(evaluate(problem, radii_of(areas)));
}

Vector3d weaker_side(FrameProblem problem) {
  problem.load_cases = {top_load(problem, "x", kForceN * Vector3d::UnitX())};
  const double along_x = demand_at_lower_bounds(problem);
  problem.load_cases = {top_load(problem, "y", kForceN * Vector3d::UnitY())};
  return demand_at_lower_bounds(problem) > along_x ? Vector3d::UnitY() : Vector3d::UnitX();
}

void set_cases(FrameProblem& problem, LoadKind kind, double force_n, const Vector3d& side) {
  problem.load_cases.clear();
  switch (kind) {
    case LoadKind::kSelf:
      problem.load_cases.push_back(top_load(problem, "self-weight", Vector3d::Zero()));
      return;
    case LoadKind::kSide:
      problem.load_cases.push_back(top_load(problem, "side", force_n * side));
      return;
    case LoadKind::kThree:
      problem.load_cases.push_back(top_load(problem, "side-y", {0, force_n, 0}));
      problem.load_cases.push_back(top_load(problem, "side-x", {force_n, 0, 0}));
      problem.load_cases.push_back(top_load(problem, "down", {0, 0, -force_n}));
      return;
    case LoadKind::kTop5:
      problem.load_cases.push_back(top_load(problem, "top", {0, 0, -force_n}));
      return;
  }
}

}  // namespace

std::optional<LoadKind> load_kind(const std::string& name) {
  for (const auto& [known, kind] : kKinds)
    if (known == name) return kind;
  return std::nullopt;
}

std::vector<std::string> load_names() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : kKinds) names.push_back(name);
  return names;
}

LoadedProblem with_loads(FrameProblem problem, LoadKind kind, bool demanding) {
  LoadedProblem loaded{std::move(problem), 0};
  if (kind == LoadKind::kTop5) loaded.force_n = kTopForceN;
  if (kind == LoadKind::kSide || kind == LoadKind::kThree) loaded.force_n = kForceN;
  const Vector3d side = kind == LoadKind::kSide ? weaker_side(loaded.problem) : Vector3d::Zero();
  set_cases(loaded.problem, kind, loaded.force_n, side);
  if (!demanding || kind == LoadKind::kSelf || kind == LoadKind::kTop5) return loaded;
  for (int doubling = 0; doubling < kMostDoublings && demand_at_lower_bounds(loaded.problem) < kDemanding;
       ++doubling) {
    loaded.force_n *= 2;
    set_cases(loaded.problem, kind, loaded.force_n, side);
  }
  return loaded;
}

}  // namespace skinframe::bench
