// SPDX-License-Identifier: GPL-3.0-or-later
// Garland and Heckbert 1997, surface simplification using quadric error metrics: which edge goes next, and
// where to.
#include "worker/export/thin_block.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "worker/export/block_mesh.h"
#include "worker/export/collapse_trial.h"

namespace skinframe {
namespace {

constexpr double kMiddle = 1e-4;  // weight of the edge's middle beside the planes: decides where these do not
constexpr double kShortFirst = 1e-6;  // of the squared length, beside the cost: the order where all is flat
constexpr double kFurthestInEdges = 2.0;  // a new place from the middle of the edge

// x^T A x + 2 b x + c: the sum over planes of area times squared distance, and the sum of those areas.
struct Quadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double c = 0.0, area = 0.0;

  void operator+=(const Quadric& q) {
    a += q.a;
    b += q.b;
    c += q.c;
    area += q.area;
  }
  double mean(const Eigen::Vector3d& x) const {
    return std::max(0.0, x.dot(a * x) + 2.0 * b.dot(x) + c) / area;
  }
};

struct Candidate {
  float cost;  // about the mean squared distance, mm2
  int u, v;
  std::uint32_t stamp;    // of both ends together, when it was judged
  Eigen::Vector3f place;  // where it should go
  // A heap's top is its greatest: the least cost, then the first edge.
  bool operator<(const Candidate& o) const {
    return cost != o.cost ? cost > o.cost : u != o.u ? u > o.u : v > o.v;
  }
};

// The solution of a x = r, for a symmetric and positive definite.
Eigen::Vector3d solve(const Eigen::Matrix3d& a, const Eigen::Vector3d& r) {
  const double c00 = a(1, 1) * a(2, 2) - a(1, 2) * a(1, 2), c01 = a(0, 2) * a(1, 2) - a(0, 1) * a(2, 2),
               c02 = a(0, 1) * a(1, 2) - a(0, 2) * a(1, 1), c11 = a(0, 0) * a(2, 2) - a(0, 2) * a(0, 2),
               c12 = a(0, 1) * a(0, 2) - a(0, 0) * a(1, 2), c22 = a(0, 0) * a(1, 1) - a(0, 1) * a(0, 1);
  const double det = a(0, 0) * c00 + a(0, 1) * c01 + a(0, 2) * c02;
  return Eigen::Vector3d(c00 * r[0] + c01 * r[1] + c02 * r[2], c01 * r[0] + c11 * r[1] + c12 * r[2],
                         c02 * r[0] + c12 * r[1] + c22 * r[2]) /
         det;
}

class Block {
 public:
  Block(ThinningState& state, const ThinningBlock& block, const BlockLimits& limits, bool is_exact)
      : block_(block),
        limits_(limits),
        origin_(block.box.center()),
        mesh_(state, block),
        trial_(state, block, limits, is_exact, mesh_) {
    stamps_.assign(mesh_.vertices(), 0);
    quadrics_.resize(mesh_.vertices());
    for (int t = 0; t < mesh_.own(); ++t) add_planes(t);
    for (int t = 0; t < mesh_.own(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int u = mesh_.triangle(t)[k], v = mesh_.triangle(t)[(k + 1) % 3];
        if (u < v) consider(u, v);
      }
    }
    std::make_heap(heap_.begin(), heap_.end());
    is_heap_ = true;
  }

  void run() {
    std::size_t left = mesh_.own();
    while (!heap_.empty() && left > limits_.triangles) {
      std::pop_heap(heap_.begin(), heap_.end());
      const Candidate next = heap_.back();
      heap_.pop_back();
      if (next.stamp == stamps_[next.u] + stamps_[next.v] && !mesh_.is_dead(next.u) && !mesh_.is_dead(next.v))
        left -= 2 * try_collapse(next);
    }
  }
  bool stays_on_surface() const { return trial_.stays_on_surface(); }
  void write_back() const { mesh_.write_back(); }

 private:
  void add_planes(int t) {
    const Corners p = mesh_.corners_of(t);
    const Eigen::Vector3d normal = normal_of(p);
    const double twice_area = normal.norm();
    if (!(twice_area > 0.0)) return;
    const Eigen::Vector3d n = normal / twice_area;
    const double d = -n.dot(p[0] - origin_);
    for (int k = 0; k < 3; ++k) {
      Quadric& q = quadrics_[mesh_.triangle(t)[k]];
      q.a += twice_area * (n * n.transpose());
      q.b += twice_area * d * n;
      q.c += twice_area * d * d;
      q.area += twice_area;
    }
  }

  // Where the edge should go, in exact floats, and its cost there.
  std::optional<std::pair<Eigen::Vector3d, double>> best_place(int u, int v) const {
    Quadric q = quadrics_[u];
    q += quadrics_[v];
    if (!(q.area > 0.0)) return std::nullopt;
    const Eigen::Vector3d pu = mesh_.place(u), pv = mesh_.place(v);
    if (mesh_.is_exact(u) || mesh_.is_exact(v)) {
      const double cu = q.mean(pu - origin_), cv = q.mean(pv - origin_);
      return cu <= cv ? std::pair{pu, cu} : std::pair{pv, cv};
    }
    const Eigen::Vector3d middle = 0.5 * (pu + pv);
    const Eigen::Vector3d at = middle - origin_;
    const Eigen::Matrix3d a = q.a + kMiddle * q.area * Eigen::Matrix3d::Identity();
    Eigen::Vector3d place = middle - solve(a, q.a * at + q.b);
    if (!((place - middle).squaredNorm() <= kFurthestInEdges * kFurthestInEdges * (pu - pv).squaredNorm()))
      place = middle;
    place = place.cast<float>().cast<double>();
    return std::pair{place, q.mean(place - origin_)};
  }

  void consider(int u, int v) {
    if (mesh_.is_locked(u) || mesh_.is_locked(v)) return;
    const auto best = best_place(u, v);
    if (!best || !(best->second <= limits_.quadric_mm * limits_.quadric_mm) ||
        !block_.box.contains(best->first))
      return;
    heap_.push_back({static_cast<float>(best->second), std::min(u, v), std::max(u, v),
                     stamps_[u] + stamps_[v], best->first.cast<float>()});
    if (is_heap_) std::push_heap(heap_.begin(), heap_.end());
  }

  // All edges about a changed vertex are judged again, those too that were refused before.
  bool try_collapse(const Candidate& edge) {
    const Eigen::Vector3d place = edge.place.cast<double>();
    if (!trial_.holds(edge.u, edge.v, place)) return false;
    trial_.carry_out(edge.u, edge.v, place);
    ++stamps_[edge.u];
    quadrics_[edge.u] += quadrics_[edge.v];
    mesh_.gather(edge.u, around_);
    mesh_.neighbours(edge.u, around_, near_);
    for (int w : near_) consider(edge.u, w);
    return true;
  }

  const ThinningBlock& block_;
  const BlockLimits& limits_;
  const Eigen::Vector3d origin_;
  BlockMesh mesh_;
  CollapseTrial trial_;
  std::vector<std::uint32_t> stamps_;  // of each vertex: how often it has changed
  std::vector<Quadric> quadrics_;
  std::vector<Candidate> heap_;
  bool is_heap_ = false;
  std::vector<int> around_, near_;
};

}  // namespace

void thin_block(ThinningState& state, const ThinningBlock& block, const BlockLimits& limits) {
  // Believing the points is right in nearly all blocks, and sooner done than asking the surface of each try.
  for (const bool is_exact : {false, true}) {
    Block thinned(state, block, limits, is_exact);
    thinned.run();
    if (!is_exact && !thinned.stays_on_surface()) continue;
    thinned.write_back();
    return;
  }
}

}  // namespace skinframe
