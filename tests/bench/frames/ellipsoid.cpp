// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/frames/ellipsoid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "tests/worker/fixture/geodesic_sphere.h"
#include "worker/pipeline/pose_problem.h"

namespace skinframe::bench {
namespace {

using Eigen::Vector3d;

constexpr double kHeightMm = 180, kSkinMm = 1.0;
constexpr double kBaseCut = -0.75;       // of the vertical half axis
constexpr double kSkinShare = 0.58;      // of the nodes, about
constexpr double kMarginInEdges = 0.35;  // of internal nodes below the skin
constexpr int kCandidates = 20;
constexpr double kLeastRoomMm = 1.0;

const Vector3d kHalfAxes = kHeightMm / (1 - kBaseCut) * Vector3d(0.58, 0.45, 1);
const double kCentreZ = -kBaseCut * kHalfAxes.z();

void add_skin(int nodes, Frame& frame) {
  const int frequency = std::max(2, static_cast<int>(std::lround(std::sqrt((kSkinShare * nodes - 2) / 10))));
  frame = test::geodesic_sphere(frequency);
  for (Vector3d& p : frame.nodes_mm) {
    p = p.cwiseProduct(kHalfAxes);
    p.z() = std::max(p.z() + kCentreZ, 0.0);
  }
}

double mean_skin_edge(const Frame& frame) {
  double sum = 0;
  for (const Strut& strut : frame.struts) sum += frame.length_mm(strut);
  return sum / static_cast<double>(frame.struts.size());
}

// Each point is the one of a few candidates farthest from the internal points before it.
void add_internal_nodes(int count, Frame& frame) {
  std::mt19937 generator(7);  // its own numbers, not a distribution's: those differ between libraries
  const auto uniform = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  const double margin = kMarginInEdges * mean_skin_edge(frame);
  const Vector3d inner = (kHalfAxes.array() - margin).max(kLeastRoomMm);
  std::vector<Vector3d> points;
  while (static_cast<int>(points.size()) < count) {
    Vector3d best = Vector3d::Zero();
    double farthest = -1;
    for (int candidates = 0; candidates < kCandidates;) {
      const Vector3d unit(2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1);
      const Vector3d p = unit.cwiseProduct(inner) + Vector3d(0, 0, kCentreZ);
      if (unit.squaredNorm() >= 1 || p.z() < margin) continue;
      ++candidates;
      double nearest = 1e30;
      for (const Vector3d& q : points) nearest = std::min(nearest, (q - p).squaredNorm());
      if (nearest > farthest) farthest = nearest, best = p;
    }
    points.push_back(best);
  }
  frame.nodes_mm.insert(frame.nodes_mm.end(), points.begin(), points.end());
}

// To the nearest node from every internal node, then to the second nearest, and so on.
void add_internal_struts(int wanted, Frame& frame) {
  const int n = static_cast<int>(frame.nodes_mm.size()), first = frame.skin_node_count;
  const int missing = wanted - static_cast<int>(frame.struts.size());
  const int ranks = std::min(n - 1, 2 * missing / (n - first) + 8);
  std::vector<std::vector<int>> nearest(n);
  for (int i = first; i < n; ++i) {
    std::vector<std::pair<double, int>> others;
    for (int k = 0; k < n; ++k)
      if (k != i) others.emplace_back((frame.nodes_mm[i] - frame.nodes_mm[k]).squaredNorm(), k);
    std::partial_sort(others.begin(), others.begin() + ranks, others.end());
    for (int q = 0; q < ranks; ++q) nearest[i].push_back(others[q].second);
  }
  std::set<std::pair<int, int>> known;
  for (int q = 0; q < ranks; ++q)
    for (int i = first; i < n && static_cast<int>(frame.struts.size()) < wanted; ++i)
      if (known.insert(std::minmax(i, nearest[i][q])).second)
        frame.struts.push_back({i, nearest[i][q], false});
}

void add_skin_weight(FrameProblem& problem) {
  const Frame& frame = problem.frame;
  problem.skin_weight_n.assign(frame.nodes_mm.size(), 0);
  for (const auto& t : frame.skin_triangles) {
    const Vector3d &a = frame.nodes_mm[t[0]], &b = frame.nodes_mm[t[1]], &c = frame.nodes_mm[t[2]];
    const double weight =
        0.5 * (b - a).cross(c - a).norm() * kSkinMm * problem.material.weight_density_n_mm3();
    for (int i : t) problem.skin_weight_n[i] += weight / 3;
    problem.skin_mass.centroid_mm += weight * (a + b + c) / 3;
    problem.skin_mass.weight_n += weight;
  }
  problem.skin_mass.centroid_mm /= problem.skin_mass.weight_n;
}

}  // namespace

bool is_possible(const FrameSize& size) {
  return size.nodes >= 60 && size.nodes <= 100'000 && size.struts >= 4 * size.nodes &&
         size.struts <= 12 * size.nodes;
}

FrameProblem make_ellipsoid(const FrameSize& size) {
  SKINFRAME_CHECK(is_possible(size));
  FrameProblem problem;
  problem.material = {"pa", 1586, 1387, 43, 48, 60, 1.15};
  Frame& frame = problem.frame;
  add_skin(size.nodes, frame);
  add_internal_nodes(size.nodes - frame.skin_node_count, frame);
  add_internal_struts(size.struts, frame);
  SKINFRAME_CHECK(static_cast<int>(frame.nodes_mm.size()) == size.nodes);
  SKINFRAME_CHECK(static_cast<int>(frame.struts.size()) == size.struts);

  for (const Strut& strut : frame.struts) problem.bounds.push_back({0.5, strut.is_skin ? 1.0 : 5.0});
  std::vector<int> contact;
  for (int i = 0; i < frame.skin_node_count; ++i)
    if (frame.nodes_mm[i].z() < 1e-9) contact.push_back(i);
  problem.fixed = hold_contact(frame, contact, Supports::kLeast);
  problem.displacement_limit_mm = 0.05;
  add_skin_weight(problem);
  problem.free_nodes.assign(frame.nodes_mm.size(), false);
  for (int i = frame.skin_node_count; i < size.nodes; ++i) problem.free_nodes[i] = true;
  return problem;
}

}  // namespace skinframe::bench
