// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/worker/optimize/test_frames.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "tests/worker/fixture/geodesic_sphere.h"
#include "tests/worker/mechanics/small_frames.h"

namespace skinframe::testing {
namespace {

using Eigen::Vector3d;

constexpr double kBaseCut = -0.75;  // of the vertical half axis: below it the egg is flat

// Each point is the one of a few candidates farthest from the points before it.
void add_internal_nodes(Frame& frame, int count, const Vector3d& half_axes, double centre_z) {
  std::mt19937 generator(7);
  const auto uniform = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  const auto inside = [&](const Vector3d& p) {
    return ((p - Vector3d(0, 0, centre_z)).array() / (0.9 * half_axes.array())).square().sum() < 1 &&
           p.z() > 3;
  };
  const std::size_t skin = frame.nodes_mm.size();
  for (int i = 0; i < count; ++i) {
    Vector3d best = Vector3d::Zero();
    double farthest = -1;
    for (int candidates = 0; candidates < 12;) {
      const Vector3d p((2 * uniform() - 1) * half_axes.x(), (2 * uniform() - 1) * half_axes.y(),
                       centre_z + (2 * uniform() - 1) * half_axes.z());
      if (!inside(p)) continue;
      ++candidates;
      double nearest = 1e30;
      for (std::size_t k = skin; k < frame.nodes_mm.size(); ++k)
        nearest = std::min(nearest, (frame.nodes_mm[k] - p).norm());
      if (nearest > farthest) farthest = nearest, best = p;
    }
    frame.nodes_mm.push_back(best);
  }
}

void add_internal_struts(Frame& frame, int neighbours) {
  std::set<std::pair<int, int>> known;
  for (const Strut& strut : frame.struts) known.insert(std::minmax(strut.a, strut.b));
  const int n = static_cast<int>(frame.nodes_mm.size());
  for (int i = frame.skin_node_count; i < n; ++i) {
    std::vector<std::pair<double, int>> others;
    for (int k = 0; k < n; ++k)
      if (k != i) others.emplace_back((frame.nodes_mm[i] - frame.nodes_mm[k]).norm(), k);
    std::sort(others.begin(), others.end());
    for (int q = 0; q < neighbours && q < static_cast<int>(others.size()); ++q)
      if (known.insert(std::minmax(i, others[q].second)).second)
        frame.struts.push_back({i, others[q].second, false});
  }
}

void support(FrameProblem& problem) {
  const auto& nodes = problem.frame.nodes_mm;
  problem.fixed.assign(nodes.size(), {false, false, false});
  int central = -1, outer = -1;
  for (int i = 0; i < problem.frame.skin_node_count; ++i) {
    if (nodes[i].z() > 1e-9) continue;
    problem.fixed[i][2] = true;
    if (central < 0 || nodes[i].norm() < nodes[central].norm()) central = i;
    if (outer < 0 || nodes[i].x() > nodes[outer].x()) outer = i;
  }
  problem.fixed[central] = {true, true, true};
  problem.fixed[outer][1] = true;
}

}  // namespace

Material pa_plastic() { return {"pa", 1586, 1387, 43, 48, 60, 1.15}; }

FrameProblem make_egg(const Egg& egg) {
  FrameProblem problem;
  Frame& frame = problem.frame;
  frame = test::geodesic_sphere(egg.frequency);
  const Vector3d half_axes = egg.height_mm / (1 - kBaseCut) * Vector3d(0.58, 0.45, 1);
  const double centre = -kBaseCut * half_axes.z();
  for (Vector3d& p : frame.nodes_mm) {
    p = p.cwiseProduct(half_axes);
    p.z() = std::max(p.z() + centre, 0.0);
  }
  add_internal_nodes(frame, egg.internal_nodes, half_axes, centre);
  add_internal_struts(frame, egg.neighbours);

  problem.material = pa_plastic();
  for (const Strut& strut : frame.struts) problem.bounds.push_back({0.5, strut.is_skin ? 1.0 : 5.0});
  support(problem);
  problem.displacement_limit_mm = 0.05;
  const std::size_t nodes = frame.nodes_mm.size();
  problem.skin_weight_n.assign(nodes, 0);
  for (const auto& t : frame.skin_triangles) {
    const Vector3d &a = frame.nodes_mm[t[0]], &b = frame.nodes_mm[t[1]], &c = frame.nodes_mm[t[2]];
    const double weight =
        0.5 * (b - a).cross(c - a).norm() * egg.skin_thickness_mm * problem.material.weight_density_n_mm3();
    for (int i : t) problem.skin_weight_n[i] += weight / 3;
    problem.skin_mass.centroid_mm += weight * (a + b + c) / 3;
    problem.skin_mass.weight_n += weight;
  }
  problem.skin_mass.centroid_mm /= problem.skin_mass.weight_n;
  problem.free_nodes.assign(nodes, false);
  for (std::size_t i = frame.skin_node_count; i < nodes; ++i) problem.free_nodes[i] = true;
  return problem;
}

LoadCase top_load(const FrameProblem& problem, const std::string& name, const Vector3d& force_n) {
  const auto& nodes = problem.frame.nodes_mm;
  double top = 0;
  for (const Vector3d& p : nodes) top = std::max(top, p.z());
  LoadCase load{name, true, std::vector<Vector3d>(nodes.size(), Vector3d::Zero())};
  std::vector<int> carrying;
  for (int i = 0; i < problem.frame.skin_node_count; ++i)
    if (nodes[i].z() > top - 8) carrying.push_back(i);
  for (int i : carrying) load.force_n[i] = force_n / static_cast<double>(carrying.size());
  return load;
}

std::vector<HalfPlane> base_hull(const Frame& frame, double margin_mm) {
  std::vector<Eigen::Vector2d> points;
  for (const Vector3d& p : frame.nodes_mm)
    if (p.z() < 1e-9) points.push_back(p.head<2>());
  std::vector<HalfPlane> hull;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (i == k) continue;
      const Eigen::Vector2d along = points[k] - points[i];
      const Eigen::Vector2d normal = Eigen::Vector2d(along.y(), -along.x()).normalized();
      const bool edge = std::all_of(points.begin(), points.end(),
                                    [&](const auto& p) { return normal.dot(p - points[i]) <= 1e-9; });
      if (edge) hull.push_back({normal, normal.dot(points[i]) - margin_mm});
    }
  return hull;
}

FrameProblem pulled_chain(double force_n) {
  FrameProblem problem = chain(3, 90);
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 3, {force_n, 0, 0})};
  return problem;
}

FrameProblem ten_bar_truss() {
  FrameProblem problem =
      bare_problem({{720, 0, 360}, {720, 0, 0}, {360, 0, 360}, {360, 0, 0}, {0, 0, 360}, {0, 0, 0}},
                   {{4, 2}, {2, 0}, {5, 3}, {3, 1}, {2, 3}, {0, 1}, {4, 3}, {5, 2}, {2, 1}, {3, 0}});
  problem.element = ElementModel::kAxial;
  problem.material.tensile_modulus_mpa = 1e4;
  problem.material.tensile_strength_mpa = 25;
  for (RadiusBounds& b : problem.bounds) b = {std::sqrt(0.1 / std::numbers::pi), 5};
  for (int i = 0; i < 6; ++i) problem.fixed[i] = {i >= 4, true, i >= 4};
  problem.load_cases = {load_at(problem, 1, {0, 0, -100})};
  problem.load_cases[0].force_n[3] = {0, 0, -100};
  return problem;
}

OptimizeResult size_only(const FrameProblem& problem) {
  OptimizeOptions options;
  options.relaxed = options.topology = options.geometry = false;
  RunContext context;
  auto result = optimize_frame(problem, options, context);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return std::move(result).value();
}

}  // namespace skinframe::testing
