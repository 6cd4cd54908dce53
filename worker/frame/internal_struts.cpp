// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/internal_struts.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "worker/frame/convex_region.h"
#include "worker/frame/disjoint_sets.h"
#include "worker/frame/point_tree.h"

namespace skinframe {
namespace {

constexpr int kEnoughStruts = 4;
constexpr int kLeastStruts = 3;
constexpr int kSearchFurther = 3;        // times `neighbours`
constexpr double kMostNodesAdded = 0.1;  // of the internal nodes
constexpr int kStepsInwards = 24;        // of a voxel each, of a dividing node
constexpr double kDepthInRadii = 2.0;    // of a dividing node's surface below M1, beside its radius
constexpr double kApartInRadii = 6.0;    // dividing node from the ends of its strut

using Pairs = std::set<std::pair<int, int>>;

class StrutMaker {
 public:
  StrutMaker(Frame& frame, const InternalStruts& options, const Skin& skin)
      : frame_(frame),
        options_(options),
        skin_(skin),
        tree_(frame.nodes_mm),
        degree_(frame.nodes_mm.size(), 0) {}

  bool fits(const Strut& strut) const {
    const double radius = std::max(
        options_.radius_mm, options_.slenderness ? frame_.length_mm(strut) / *options_.slenderness : 0.0);
    if (room_mm(options_.openings, frame_.nodes_mm[strut.a], frame_.nodes_mm[strut.b]) < radius) return false;
    return strut_excess_mm(frame_, strut, options_.radius_mm, skin_) <= inside_tolerance_mm(skin_);
  }

  void join_nearest(int i) {
    int rank = 0;
    for (const int j : tree_.nearest(frame_.nodes_mm[i], 1 + kSearchFurther * options_.neighbours)) {
      if (j == i) continue;
      if (++rank > options_.neighbours && degree_[i] >= kEnoughStruts) break;
      if (!tried_.insert(std::minmax(i, j)).second) continue;
      add_if_fits(i, j);
    }
  }

  // Struts of node i that leave M1, nearest first, each divided once; false when nothing helped.
  bool divide_for(int i) {
    bool helped = false;
    for (const int j : tree_.nearest(frame_.nodes_mm[i], 1 + options_.neighbours)) {
      if (degree_[i] >= kEnoughStruts) break;
      if (j == i || !tried_.contains(std::minmax(i, j)) || joined_.contains(std::minmax(i, j))) continue;
      const auto node = inward_of(frame_.nodes_mm[i], frame_.nodes_mm[j]);
      if (!node) continue;
      const int k = static_cast<int>(frame_.nodes_mm.size());
      frame_.nodes_mm.push_back(*node);
      if (!fits({i, k, false}) || !fits({j, k, false})) {
        frame_.nodes_mm.pop_back();
        continue;
      }
      degree_.push_back(0);
      helped = true;
      ++added_;
      add_if_fits(i, k);
      add_if_fits(j, k);
      for (const int n : tree_.nearest(*node, options_.neighbours)) {
        if (degree_[k] >= kEnoughStruts) break;
        if (n != i && n != j) add_if_fits(n, k);
      }
    }
    return helped;
  }

  int degree(int i) const { return degree_[i]; }
  int added() const { return added_; }

 private:
  void add_if_fits(int i, int j) {
    const Strut strut{std::min(i, j), std::max(i, j), false};
    if (!fits(strut)) return;
    frame_.struts.push_back(strut);
    joined_.insert(std::minmax(i, j));
    ++degree_[i];
    ++degree_[j];
  }

  // From the middle of a segment down the slope of the distance field, to where a strut has room.
  std::optional<Eigen::Vector3d> inward_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    Eigen::Vector3d p = 0.5 * (a + b);
    const double wanted = skin_.thickness_mm + (1.0 + kDepthInRadii) * options_.radius_mm;
    for (int step = 0; step < kStepsInwards && skin_.field.at(p) > -wanted; ++step) {
      const Eigen::Vector3d gradient = skin_.field.gradient(p);
      if (gradient.squaredNorm() < 0.25) return std::nullopt;
      p -= 2.0 * skin_.voxel_mm * gradient.normalized();
    }
    if (skin_.field.at(p) > -wanted) return std::nullopt;
    if (std::min((p - a).norm(), (p - b).norm()) < kApartInRadii * options_.radius_mm) return std::nullopt;
    return p;
  }

  Frame& frame_;
  const InternalStruts& options_;
  const Skin& skin_;
  PointTree tree_;  // of the nodes before any was added
  std::vector<int> degree_;
  Pairs tried_, joined_;
  int added_ = 0;
};

// Leaves out the longer of two struts that cross, longest last: sorted by x, so that only struts whose boxes
// meet are compared.
int drop_crossing(Frame& frame, const InternalStruts& options) {
  const std::size_t n = frame.struts.size();
  const auto least_radius = [&](const Strut& s) {
    return std::max(options.radius_mm, options.slenderness ? frame.length_mm(s) / *options.slenderness : 0.0);
  };
  const auto stays = [&](const Strut& s) {
    return s.is_skin || (s.a < frame.skin_node_count && s.b < frame.skin_node_count);
  };
  std::vector<Eigen::Vector3d> low(n), high(n);
  for (std::size_t j = 0; j < n; ++j) {
    const Strut& s = frame.struts[j];
    const Eigen::Vector3d &a = frame.nodes_mm[s.a], &b = frame.nodes_mm[s.b];
    const double r = least_radius(s);
    low[j] = a.cwiseMin(b).array() - r;
    high[j] = a.cwiseMax(b).array() + r;
  }
  std::vector<std::size_t> by_x(n);
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::stable_sort(by_x.begin(), by_x.end(), [&](auto i, auto j) { return low[i].x() < low[j].x(); });
  std::vector<std::pair<std::size_t, std::size_t>> crossings;  // the worse, the better
  const auto worse = [&](std::size_t i, std::size_t j) {
    const Strut &s = frame.struts[i], &t = frame.struts[j];
    if (stays(s) != stays(t)) return stays(t);
    const double ls = frame.length_mm(s), lt = frame.length_mm(t);
    return ls != lt ? ls > lt : i > j;
  };
  for (std::size_t p = 0; p < n; ++p) {
    const std::size_t i = by_x[p];
    const Strut& s = frame.struts[i];
    for (std::size_t q = p + 1; q < n && low[by_x[q]].x() <= high[i].x(); ++q) {
      const std::size_t j = by_x[q];
      const Strut& t = frame.struts[j];
      if (stays(s) && stays(t)) continue;
      if (s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b) continue;
      if ((low[i].array() > high[j].array()).any() || (low[j].array() > high[i].array()).any()) continue;
      const double apart = segment_distance_mm(frame.nodes_mm[s.a], frame.nodes_mm[s.b], frame.nodes_mm[t.a],
                                               frame.nodes_mm[t.b]);
      if (apart >= least_radius(s) + least_radius(t)) continue;
      crossings.push_back(worse(i, j) ? std::pair(i, j) : std::pair(j, i));
    }
  }
  // The best struts are kept first; a strut goes when it crosses one that is kept.
  std::stable_sort(crossings.begin(), crossings.end(), [&](const auto& x, const auto& y) {
    return x.first != y.first && worse(y.first, x.first);
  });
  std::vector<char> gone(n, 0);
  for (const auto& [bad, good] : crossings)
    if (!gone[good]) gone[bad] = 1;
  std::vector<Strut> kept;
  for (std::size_t j = 0; j < n; ++j)
    if (!gone[j]) kept.push_back(frame.struts[j]);
  frame.struts = std::move(kept);
  return static_cast<int>(n - frame.struts.size());
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

}  // namespace

double segment_distance_mm(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1, const Eigen::Vector3d& b0,
                           const Eigen::Vector3d& b1) {  // Ericson, Real-Time Collision Detection, 5.1.9
  const Eigen::Vector3d u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 1e-12 * uu * vv ? std::clamp((uv * vw - uw * vv) / determinant, 0.0, 1.0) : 0.0;
  double t = vv > 0.0 ? (uv * s + vw) / vv : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0.0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0.0;
  }
  return (w + s * u - t * v).norm();
}

InternalStrutCounts add_internal_struts(Frame& frame, const InternalStruts& options, const Skin& skin) {
  const int n = static_cast<int>(frame.nodes_mm.size());
  StrutMaker maker(frame, options, skin);
  for (int i = frame.skin_node_count; i < n; ++i) maker.join_nearest(i);
  const double most_added = kMostNodesAdded * (n - frame.skin_node_count);
  for (int i = frame.skin_node_count; i < n && maker.added() < most_added; ++i)
    if (maker.degree(i) < kEnoughStruts) maker.divide_for(i);
  InternalStrutCounts counts;
  counts.nodes_added = maker.added();
  counts.struts_crossing = drop_crossing(frame, options);
  while (drop_unheld_nodes(frame)) {
  }
  return counts;
}

}  // namespace skinframe
