// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/thin_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "worker/export/block_grid.h"
#include "worker/export/triangle_gap.h"

namespace skinframe {
namespace {

constexpr double kLeastTurnCosine = 0.3;   // of a triangle's normal in one collapse
constexpr double kLeastFoldCosine = -0.9;  // of two triangles with a side in common
constexpr double kLeastRoundness = 0.03;   // 4 sqrt(3) area / sum of squared sides: 1 where all are equal
constexpr double kMiddle = 1e-4;  // weight of the edge's middle beside the planes: decides where these do not
constexpr double kShortFirst = 1e-6;  // of the squared length, beside the cost: the order where all is flat
constexpr double kFurthestInEdges = 2.0;  // a new place from the middle of the edge
constexpr double kCellInEdges = 1.2;
constexpr double kClear = 0.4;  // of the deviation: below it the points are trusted
constexpr double kAbout =
    1.5;  // times the distance of the nearest point: others that tell of the surface there

Eigen::Vector3d normal_of(const Corners& p) { return (p[1] - p[0]).cross(p[2] - p[0]); }

double roundness(const Corners& p, double twice_area) {
  const double sides =
      (p[1] - p[0]).squaredNorm() + (p[2] - p[1]).squaredNorm() + (p[0] - p[2]).squaredNorm();
  return sides > 0.0 ? 2.0 * std::sqrt(3.0) * twice_area / sides : 0.0;
}

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
  std::uint32_t stamp;  // of both ends together, when it was judged
  // A heap's top is its greatest: the least cost, then the first edge.
  bool operator<(const Candidate& o) const {
    return cost != o.cost ? cost > o.cost : u != o.u ? u > o.u : v > o.v;
  }
};

class Block {
 public:
  Block(ThinningState& state, const ThinningBlock& block, const BlockLimits& limits)
      : state_(state), block_(block), limits_(limits), origin_(block.box.center()) {
    number_vertices();
    link_triangles();
    for (int t = 0; t < own_; ++t) add_planes(t);
    if (limits_.is_bounded) fill_grid();
    for (int t = 0; t < own_; ++t) {
      for (int k = 0; k < 3; ++k) {
        const int u = triangles_[t][k], v = triangles_[t][(k + 1) % 3];
        if (u < v) consider(u, v);
      }
    }
  }

  void run() {
    std::size_t left = own_;
    while (!heap_.empty() && left > limits_.triangles) {
      std::pop_heap(heap_.begin(), heap_.end());
      const Candidate next = heap_.back();
      heap_.pop_back();
      if (next.stamp == stamps_[next.u] + stamps_[next.v] && !dead_[next.u] && !dead_[next.v] &&
          try_collapse(next.u, next.v))
        left -= 2;
    }
  }

  void write_back() {
    TriangleMesh& mesh = *state_.mesh;
    for (std::size_t v = 0; v < places_.size(); ++v) {
      if (!locked_[v]) mesh.vertices[numbers_[v]] = places_[v];
    }
    for (int t = 0; t < own_; ++t) {
      const int global = block_.own[t];
      state_.gone[global] = !slots_[t].alive;
      for (int k = 0; k < 3; ++k) mesh.triangles[global][k] = numbers_[triangles_[t][k]];
      for (int p = first_point_[t]; p >= 0; p = next_point_[p]) state_.points[points_[p]].triangle = global;
    }
  }

 private:
  // All that a search meets of a triangle, in one line of the cache.
  struct alignas(64) Slot {
    Eigen::Matrix3f shape;  // its corners: all are exact floats
    std::uint32_t seen = 0;
    bool alive = true;
  };
  // A triangle as the collapse being tried would leave it.
  struct Changed {
    int triangle;
    Corners corners;
    Eigen::AlignedBox3d box;
    Eigen::Vector3d normal;  // not of unit length
  };

  void number_vertices() {
    const auto& all = state_.mesh->triangles;
    own_ = static_cast<int>(block_.own.size());
    for (const auto* list : {&block_.own, &block_.beside})
      for (int t : *list) numbers_.insert(numbers_.end(), all[t].begin(), all[t].end());
    std::sort(numbers_.begin(), numbers_.end());
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
    for (int v : numbers_) places_.push_back(state_.mesh->vertices[v]);
    locked_.assign(numbers_.size(), 0);
    for (const auto* list : {&block_.own, &block_.beside}) {
      for (int t : *list) {
        auto& corners = triangles_.emplace_back();
        for (int k = 0; k < 3; ++k) {
          corners[k] = static_cast<int>(std::lower_bound(numbers_.begin(), numbers_.end(), all[t][k]) -
                                        numbers_.begin());
          if (list == &block_.beside) locked_[corners[k]] = 1;
        }
      }
    }
    if (state_.exact_stay)
      for (std::size_t v = 0; v < numbers_.size(); ++v) locked_[v] |= is_exact(static_cast<int>(v));
    slots_.resize(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto& c = triangles_[t];
      keep_shape_of(static_cast<int>(t), {places_[c[0]], places_[c[1]], places_[c[2]]});
    }
    dead_.assign(numbers_.size(), 0);
    stamps_.assign(numbers_.size(), 0);
    quadrics_.resize(numbers_.size());
  }

  // Lists of the own triangles about each vertex (by corner, 3 t + k), and of the points of each.
  void link_triangles() {
    first_corner_.assign(numbers_.size(), -1);
    next_corner_.assign(3 * own_, -1);
    first_point_.assign(own_, -1);
    for (int t = own_ - 1; t >= 0; --t) {
      for (int k = 2; k >= 0; --k) {
        int& first = first_corner_[triangles_[t][k]];
        next_corner_[3 * t + k] = first;
        first = 3 * t + k;
      }
      const int global = block_.own[t];
      for (int i = state_.first_point[global]; i < state_.first_point[global + 1]; ++i) {
        points_.push_back(state_.points_of[i]);
        next_point_.push_back(first_point_[t]);
        first_point_[t] = static_cast<int>(points_.size()) - 1;
      }
    }
  }

  Corners corners_of(int t) const {
    const Eigen::Matrix3f& shape = slots_[t].shape;
    return {shape.col(0).cast<double>(), shape.col(1).cast<double>(), shape.col(2).cast<double>()};
  }
  void keep_shape_of(int t, const Corners& p) {
    for (int k = 0; k < 3; ++k) slots_[t].shape.col(k) = p[k].cast<float>();
  }

  void add_planes(int t) {
    const Corners p = corners_of(t);
    const Eigen::Vector3d normal = normal_of(p);
    const double twice_area = normal.norm();
    if (!(twice_area > 0.0)) return;
    const Eigen::Vector3d n = normal / twice_area;
    const double d = -n.dot(p[0] - origin_);
    for (int k = 0; k < 3; ++k) {
      Quadric& q = quadrics_[triangles_[t][k]];
      q.a += twice_area * (n * n.transpose());
      q.b += twice_area * d * n;
      q.c += twice_area * d * d;
      q.area += twice_area;
    }
  }

  void fill_grid() {
    double sum = 0.0;
    for (int t = 0; t < own_; ++t) sum += (places_[triangles_[t][0]] - places_[triangles_[t][1]]).norm();
    grid_.emplace(block_.box, kCellInEdges * sum / std::max(1, own_), triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      grid_->insert(static_cast<int>(t), box_of(corners_of(t)));
  }

  static Eigen::AlignedBox3d box_of(const Corners& p) {
    Eigen::AlignedBox3d box(p[0]);
    box.extend(p[1]);
    box.extend(p[2]);
    return box;
  }

  bool is_exact(int v) const { return numbers_[v] < state_.exact_vertices; }

  // Where the edge should go, in exact floats, and its cost there.
  std::optional<std::pair<Eigen::Vector3d, double>> best_place(int u, int v) const {
    Quadric q = quadrics_[u];
    q += quadrics_[v];
    if (!(q.area > 0.0)) return std::nullopt;
    const Eigen::Vector3d pu = places_[u], pv = places_[v];
    if (is_exact(u) || is_exact(v)) {
      const double cu = q.mean(pu - origin_), cv = q.mean(pv - origin_);
      return cu <= cv ? std::pair{pu, cu} : std::pair{pv, cv};
    }
    const Eigen::Vector3d middle = 0.5 * (pu + pv);
    const Eigen::Vector3d at = middle - origin_;
    const Eigen::Matrix3d a = q.a + kMiddle * q.area * Eigen::Matrix3d::Identity();
    Eigen::Vector3d place = middle - a.llt().solve(q.a * at + q.b);
    if (!((place - middle).squaredNorm() <= kFurthestInEdges * kFurthestInEdges * (pu - pv).squaredNorm()))
      place = middle;
    place = place.cast<float>().cast<double>();
    return std::pair{place, q.mean(place - origin_)};
  }

  void consider(int u, int v) {
    if (locked_[u] || locked_[v]) return;
    const auto best = best_place(u, v);
    if (!best || !(best->second <= limits_.quadric_mm * limits_.quadric_mm) ||
        !block_.box.contains(best->first))
      return;
    heap_.push_back(
        {static_cast<float>(best->second), std::min(u, v), std::max(u, v), stamps_[u] + stamps_[v]});
    std::push_heap(heap_.begin(), heap_.end());
  }

  // The triangles about v, in a steady order; forgets those that are gone.
  void gather(int v, std::vector<int>& around) {
    around.clear();
    int* link = &first_corner_[v];
    while (*link >= 0) {
      if (slots_[*link / 3].alive) {
        around.push_back(*link / 3);
        link = &next_corner_[*link];
      } else {
        *link = next_corner_[*link];
      }
    }
  }

  void neighbours(int v, const std::vector<int>& around, std::vector<int>& near) const {
    near.clear();
    for (int t : around)
      for (int w : triangles_[t])
        if (w != v) near.push_back(w);
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }

  bool try_collapse(int u, int v) {
    const auto best = best_place(u, v);
    if (!best) return false;
    gather(u, around_u_);
    gather(v, around_v_);
    if (!keeps_manifold(u, v)) return false;
    new_.clear();
    star_ = around_u_;
    for (int t : around_v_)
      if (!has(t, u)) star_.push_back(t);
    for (int t : star_) {
      if (has(t, u) && has(t, v)) continue;
      Corners p = corners_of(t);
      for (int k = 0; k < 3; ++k)
        if (triangles_[t][k] == u || triangles_[t][k] == v) p[k] = best->first;
      new_.push_back({t, p, box_of(p), normal_of(p)});
    }
    if (!keeps_shape()) return false;
    if (limits_.is_bounded && !(keeps_points(u, best->first) && keeps_clear(u, v))) return false;
    collapse(u, v, best->first);
    return true;
  }

  bool has(int t, int v) const {
    const auto& c = triangles_[t];
    return c[0] == v || c[1] == v || c[2] == v;
  }

  // Two vertices may become one when they share exactly two neighbours, and the surface is a disc about each.
  bool keeps_manifold(int u, int v) {
    neighbours(u, around_u_, near_u_);
    neighbours(v, around_v_, near_v_);
    int shared = 0;
    for (int w : near_u_) shared += std::binary_search(near_v_.begin(), near_v_.end(), w);
    return shared == 2 && near_u_.size() == around_u_.size() && near_v_.size() == around_v_.size() &&
           near_u_.size() + near_v_.size() > 8;
  }

  // No triangle turns far or becomes a worse sliver than it was.
  bool keeps_shape() {
    for (const Changed& changed : new_) {
      const Corners& p = changed.corners;
      const Eigen::Vector3d& after = changed.normal;
      const Corners old = corners_of(changed.triangle);
      const Eigen::Vector3d before = normal_of(old);
      const double was = before.norm(), is = after.norm();
      if (!(is > 0.0) || after.dot(before) < kLeastTurnCosine * is * was) return false;
      const double round = roundness(p, is);
      if (round < kLeastRoundness && round < roundness(old, was)) return false;
    }
    return true;
  }

  // Every point of the old triangles is within the limit of the new ones, and these of the surface as it was.
  bool keeps_points(int u, const Eigen::Vector3d& place) {
    const double limit = limits_.deviation_mm * limits_.deviation_mm;
    moved_points_.clear();
    star_places_.clear();
    star_normals_.clear();
    for (int t : star_) {
      for (int p = first_point_[t]; p >= 0; p = next_point_[p]) {
        const SurfacePoint& point = state_.points[points_[p]];
        const Eigen::Vector3d at = point.place_mm.cast<double>();
        double least = limit;
        int nearest = -1;
        for (const Changed& changed : new_) {
          if (changed.box.squaredExteriorDistance(at) > least) continue;
          const double d = squared_distance(at, changed.corners);
          if (d > least) continue;
          least = d;
          nearest = changed.triangle;
        }
        if (nearest < 0) return false;
        moved_points_.push_back({p, nearest});
        star_places_.push_back(at);
        star_normals_.push_back(point.normal.cast<double>());
      }
    }
    if (!is_exact(u) && !is_on_surface(place)) return false;
    return std::all_of(new_.begin(), new_.end(), [&](const Changed& changed) {
      return is_on_surface((changed.corners[0] + changed.corners[1] + changed.corners[2]) / 3.0);
    });
  }

  // By the planes of the points about, the nearest one's and of those not much further; by the surface itself
  // where they are not of one mind.
  bool is_on_surface(const Eigen::Vector3d& place) const {
    double nearest = std::numeric_limits<double>::infinity(), low = nearest, high = 0.0;
    for (const auto& p : star_places_) nearest = std::min(nearest, (p - place).squaredNorm());
    for (std::size_t i = 0; i < star_places_.size(); ++i) {
      const Eigen::Vector3d to = place - star_places_[i];
      if (to.squaredNorm() > kAbout * kAbout * nearest) continue;
      const double height = std::abs(to.dot(star_normals_[i]));
      low = std::min(low, height);
      high = std::max(high, height);
    }
    if (state_.original == nullptr) return low <= limits_.deviation_mm || star_places_.empty();
    if (high <= kClear * limits_.deviation_mm && !star_places_.empty()) return true;
    return state_.original->distance_mm(place) <= limits_.deviation_mm;
  }

  // The new triangles meet no other one but where they share a corner or a side.
  bool keeps_clear(int u, int v) {
    // A fan about one vertex that faces one way everywhere does not fold.
    Eigen::Vector3d facing = Eigen::Vector3d::Zero();
    Eigen::AlignedBox3d box;
    outward_.clear();
    for (const Changed& changed : new_) {
      facing += changed.normal;
      box.extend(changed.box);
      const Corners& p = changed.corners;
      for (int k = 0; k < 3; ++k)
        outward_.push_back((p[(k + 1) % 3] - p[k]).cross(changed.normal).stableNormalized());
    }
    const bool is_fan = std::all_of(new_.begin(), new_.end(),
                                    [&](const Changed& changed) { return changed.normal.dot(facing) > 0.0; });
    for (std::size_t i = 0; !is_fan && i < new_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        if (!clear(new_[i], new_[j].triangle, new_[j].corners, u, v)) return false;
    }
    ++stamp_;
    for (int t : star_) slots_[t].seen = stamp_;
    bool good = true;
    grid_->near(box, [&](int other) {
      Slot& slot = slots_[other];
      if (!slot.alive) return false;
      if (!good || slot.seen == stamp_) return true;
      slot.seen = stamp_;
      const Corners there = corners_of(other);
      const Eigen::AlignedBox3d there_box = box_of(there);
      if (!box.intersects(there_box)) return true;
      for (const Changed& changed : new_) {
        if (!changed.box.intersects(there_box)) continue;
        if (!clear(changed, other, there, u, v)) {
          good = false;
          break;
        }
      }
      return true;
    });
    return good;
  }

  // v counts as u, since it becomes that.
  bool clear(const Changed& changed, int t, const Corners& q, int u, int v) const {
    const Corners& p = changed.corners;
    std::array<int, 3> a = triangles_[changed.triangle], b = triangles_[t];
    std::replace(a.begin(), a.end(), v, u);
    std::replace(b.begin(), b.end(), v, u);
    int shared = 0, i = 0, j = 0;
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        if (a[k] != b[l]) continue;
        ++shared;
        i = k;
        j = l;
      }
    }
    if (shared == 0) return is_beyond(changed, q, -1, -1) || are_apart(p, q);
    if (shared == 1)
      return is_beyond(changed, q, i, j) || meet_in_their_corner_only({p[i], p[(i + 1) % 3], p[(i + 2) % 3]},
                                                                      {q[j], q[(j + 1) % 3], q[(j + 2) % 3]});
    const Eigen::Vector3d n = changed.normal, m = normal_of(q);
    return shared == 2 && n.dot(m) > kLeastFoldCosine * n.norm() * m.norm();
  }

  // The quick answer: q but for its corner j, which is the corner i of the other, lies on one side of the
  // other's plane, or beyond one of its sides (that end in the corner).
  bool is_beyond(const Changed& changed, const Corners& q, int i, int j) const {
    const Eigen::Vector3d* outward = &outward_[3 * (&changed - new_.data())];
    const double margin = kLeastGapMm * changed.normal.norm();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    std::array<double, 3> beyond{low, low, low};
    for (int l = 0; l < 3; ++l) {
      if (l == j) continue;
      const double height = changed.normal.dot(q[l] - changed.corners[0]);
      low = std::min(low, height);
      high = std::max(high, height);
      for (int k = 0; k < 3; ++k) beyond[k] = std::min(beyond[k], outward[k].dot(q[l] - changed.corners[k]));
    }
    if (low > margin || high < -margin) return true;
    for (int k = 0; k < 3; ++k)
      if (beyond[k] > kLeastGapMm && (i < 0 || i == k || i == (k + 1) % 3)) return true;
    return false;
  }

  void collapse(int u, int v, const Eigen::Vector3d& place) {
    for (int t : star_) first_point_[t] = -1;
    for (const auto& [p, t] : moved_points_) {
      next_point_[p] = first_point_[t];
      first_point_[t] = p;
    }
    for (int t : star_)
      if (has(t, u) && has(t, v)) slots_[t].alive = false;
    int* end = &first_corner_[u];
    while (*end >= 0) end = &next_corner_[*end];
    *end = first_corner_[v];
    first_corner_[v] = -1;
    for (int t : around_v_) std::replace(triangles_[t].begin(), triangles_[t].end(), v, u);
    places_[u] = place;
    dead_[v] = 1;
    locked_[v] = 1;
    ++stamps_[u];
    quadrics_[u] += quadrics_[v];
    for (const Changed& changed : new_) {
      if (grid_) grid_->insert(changed.triangle, changed.box);
      keep_shape_of(changed.triangle, changed.corners);
    }
    gather(u, around_u_);
    neighbours(u, around_u_, near_u_);
    for (int w : near_u_) consider(u, w);
  }

  ThinningState& state_;
  const ThinningBlock& block_;
  const BlockLimits& limits_;
  const Eigen::Vector3d origin_;
  int own_ = 0;               // the first so many triangles are the block's own
  std::vector<int> numbers_;  // in the mesh, of each vertex
  std::vector<Eigen::Vector3d> places_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<char> dead_, locked_;
  std::vector<Slot> slots_;  // one a triangle
  std::vector<std::uint32_t> stamps_;
  std::vector<Quadric> quadrics_;
  std::vector<int> first_corner_, next_corner_;
  std::vector<int> points_, first_point_, next_point_;
  std::optional<BlockGrid> grid_;
  std::vector<Candidate> heap_;
  // Of the collapse being tried.
  std::vector<int> around_u_, around_v_, near_u_, near_v_, star_;
  std::vector<Changed> new_;
  std::vector<Eigen::Vector3d> outward_;  // three for each: of each side, in the plane, of unit length
  std::vector<Eigen::Vector3d> star_places_, star_normals_;
  std::vector<std::pair<int, int>> moved_points_;
  std::uint32_t stamp_ = 0;
};

}  // namespace

void thin_block(ThinningState& state, const ThinningBlock& block, const BlockLimits& limits) {
  Block thinning(state, block, limits);
  thinning.run();
  thinning.write_back();
}

}  // namespace skinframe
