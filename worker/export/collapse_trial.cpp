// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/collapse_trial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace skinframe {
namespace {

constexpr double kLeastTurnCosine = 0.3;   // of a triangle's normal in one collapse
constexpr double kLeastFoldCosine = -0.9;  // of two triangles with a side in common
constexpr double kLeastRoundness = 0.03;   // 4 sqrt(3) area / sum of squared sides: 1 where all are equal
constexpr double kCellInEdges = 2.2;
constexpr double kAbout =
    1.5;  // times the distance of the nearest point: others that tell of the surface there
constexpr double kFarthestBelieved = 2.0;  // in deviations: of the nearest point
constexpr double kClear = 0.4;             // of the deviation: below it the points are believed

double roundness(const Corners& p, double twice_area) {
  const double sides =
      (p[1] - p[0]).squaredNorm() + (p[2] - p[1]).squaredNorm() + (p[0] - p[2]).squaredNorm();
  return sides > 0.0 ? 2.0 * std::sqrt(3.0) * twice_area / sides : 0.0;
}

}  // namespace

CollapseTrial::CollapseTrial(const ThinningState& state, const ThinningBlock& block,
                             const BlockLimits& limits, bool is_exact, BlockMesh& mesh)
    : state_(state),
      limits_(limits),
      is_exact_(is_exact),
      mesh_(mesh),
      changed_(mesh.triangles(), 0),
      moved_(mesh.vertices(), 0) {
  if (limits_.is_bounded || limits_.is_clear) fill_grid(block.box);
}

void CollapseTrial::fill_grid(const Eigen::AlignedBox3d& box) {
  double sum = 0.0;
  for (int t = 0; t < mesh_.own(); ++t)
    sum += (mesh_.place(mesh_.triangle(t)[0]) - mesh_.place(mesh_.triangle(t)[1])).norm();
  grid_.emplace(box, kCellInEdges * sum / std::max(1, mesh_.own()), mesh_.triangles());
  for (std::size_t t = 0; t < mesh_.triangles(); ++t)
    grid_->insert(static_cast<int>(t), box_of(mesh_.corners_of(t)));
}

bool CollapseTrial::holds(int u, int v, const Eigen::Vector3d& place) {
  mesh_.gather(u, around_u_);
  mesh_.gather(v, around_v_);
  if (!keeps_manifold(u, v)) return false;
  new_.clear();
  moved_points_.clear();
  star_ = around_u_;
  for (int t : around_v_)
    if (!mesh_.has(t, u)) star_.push_back(t);
  for (int t : star_) {
    if (mesh_.has(t, u) && mesh_.has(t, v)) continue;
    Corners p = mesh_.corners_of(t);
    for (int k = 0; k < 3; ++k)
      if (mesh_.triangle(t)[k] == u || mesh_.triangle(t)[k] == v) p[k] = place;
    new_.push_back({t, p, box_of(p), normal_of(p)});
  }
  return keeps_shape() && (!limits_.is_bounded || keeps_points(u, place)) && (!grid_ || keeps_clear(u, v));
}

void CollapseTrial::carry_out(int u, int v, const Eigen::Vector3d& place) {
  mesh_.merge(u, v, place, star_, new_, moved_points_);
  moved_[u] = 1;
  for (const ChangedTriangle& changed : new_) changed_[changed.triangle] = 1;
  if (!grid_) return;
  for (const ChangedTriangle& changed : new_) grid_->insert(changed.triangle, changed.box);
}

// Two vertices may become one when they share exactly two neighbours, and the surface is a disc about each.
bool CollapseTrial::keeps_manifold(int u, int v) {
  mesh_.neighbours(u, around_u_, near_u_);
  mesh_.neighbours(v, around_v_, near_v_);
  int shared = 0;
  for (int w : near_u_) shared += mesh_.was_neighbour(w);
  return shared == 2 && near_u_.size() == around_u_.size() && near_v_.size() == around_v_.size() &&
         near_u_.size() + near_v_.size() > 8;
}

// No triangle turns far or becomes a worse sliver than it was.
bool CollapseTrial::keeps_shape() const {
  for (const ChangedTriangle& changed : new_) {
    const Corners& p = changed.corners;
    const Eigen::Vector3d& after = changed.normal;
    const Corners old = mesh_.corners_of(changed.triangle);
    const Eigen::Vector3d before = normal_of(old);
    const double was = before.norm(), is = after.norm();
    if (!(is > 0.0) || after.dot(before) < kLeastTurnCosine * is * was) return false;
    const double round = roundness(p, is);
    if (round < kLeastRoundness && round < roundness(old, was)) return false;
  }
  return true;
}

// Every point of the old triangles is within the limit of the new ones, and these of the surface as it was.
bool CollapseTrial::keeps_points(int u, const Eigen::Vector3d& place) {
  const double limit = limits_.deviation_mm * limits_.deviation_mm;
  moved_points_.clear();
  star_places_.clear();
  star_normals_.clear();
  bool all_near = true;
  for (int t : star_) {
    mesh_.for_each_point(t, [&](int p, const SurfacePoint& point) {
      const Eigen::Vector3d at = point.place_mm.cast<double>();
      double least = limit;
      int nearest = -1;
      for (const ChangedTriangle& changed : new_) {
        if (changed.box.squaredExteriorDistance(at) > least) continue;
        const double d = squared_distance(at, changed.corners);
        if (d > least) continue;
        least = d;
        nearest = changed.triangle;
      }
      all_near = all_near && nearest >= 0;
      moved_points_.push_back({p, nearest});
      star_places_.push_back(at);
      star_normals_.push_back(point.normal.cast<double>());
    });
    if (!all_near) return false;
  }
  if (!mesh_.is_exact(u) && !is_on_surface(place)) return false;
  return std::all_of(new_.begin(), new_.end(), [&](const ChangedTriangle& changed) {
    return is_on_surface((changed.corners[0] + changed.corners[1] + changed.corners[2]) / 3.0);
  });
}

// Near enough to a point of the surface in most cases. Else the planes of the points about are asked, the
// nearest one's and of those not much further, or the surface itself.
bool CollapseTrial::is_on_surface(const Eigen::Vector3d& place) const {
  const double limit = limits_.deviation_mm;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& p : star_places_) nearest = std::min(nearest, (p - place).squaredNorm());
  if (nearest <= limit * limit) return true;
  if (is_exact_ && state_.original != nullptr) return state_.original->is_within(place, limit);
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (std::size_t i = 0; i < star_places_.size(); ++i) {
    const Eigen::Vector3d to = place - star_places_[i];
    if (to.squaredNorm() > kAbout * kAbout * nearest) continue;
    const double height = std::abs(to.dot(star_normals_[i]));
    low = std::min(low, height);
    high = std::max(high, height);
  }
  if (state_.original == nullptr) return low <= limit || star_places_.empty();
  if (high <= kClear * limit && nearest <= kFarthestBelieved * kFarthestBelieved * limit * limit) return true;
  return state_.original->is_within(place, limit);
}

bool CollapseTrial::stays_on_surface() const {
  if (!limits_.is_bounded || state_.original == nullptr) return true;
  const auto is_near = [&](const Eigen::Vector3d& place) {
    return state_.original->is_within(place, limits_.deviation_mm);
  };
  for (int v = 0; v < static_cast<int>(moved_.size()); ++v)
    if (moved_[v] && !mesh_.is_dead(v) && !is_near(mesh_.place(v))) return false;
  for (int t = 0; t < mesh_.own(); ++t) {
    if (!changed_[t] || !mesh_.is_alive(t)) continue;
    const Corners p = mesh_.corners_of(t);
    if (!is_near((p[0] + p[1] + p[2]) / 3.0)) return false;
  }
  return true;
}

// The new triangles meet no other one but where they share a corner or a side.
bool CollapseTrial::keeps_clear(int u, int v) {
  // A fan about one vertex that faces one way everywhere does not fold.
  Eigen::Vector3d facing = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3d box;
  outward_.assign(new_.size(), std::nullopt);
  for (const ChangedTriangle& changed : new_) {
    facing += changed.normal;
    box.extend(changed.box);
  }
  const bool is_fan = std::all_of(new_.begin(), new_.end(), [&](const ChangedTriangle& changed) {
    return changed.normal.dot(facing) > 0.0;
  });
  for (std::size_t i = 0; !is_fan && i < new_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (!clear(new_[i], new_[j].triangle, new_[j].corners, u, v)) return false;
  }
  mesh_.begin_search();
  for (int t : star_) mesh_.see(t);
  bool good = true;
  grid_->near(box, [&](int other) {
    if (!mesh_.is_alive(other)) return false;
    if (!good || !mesh_.see(other)) return true;
    const Corners there = mesh_.corners_of(other);
    const Eigen::AlignedBox3d there_box = box_of(there);
    if (!box.intersects(there_box)) return true;
    for (const ChangedTriangle& changed : new_) {
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
bool CollapseTrial::clear(const ChangedTriangle& changed, int t, const Corners& q, int u, int v) {
  const Corners& p = changed.corners;
  std::array<int, 3> a = mesh_.triangle(changed.triangle), b = mesh_.triangle(t);
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

const CollapseTrial::Outward& CollapseTrial::outward_of(const ChangedTriangle& changed) {
  std::optional<Outward>& outward = outward_[&changed - new_.data()];
  if (outward) return *outward;
  const Corners& p = changed.corners;
  const auto of_side = [&](int k) -> Eigen::Vector3d {
    return (p[(k + 1) % 3] - p[k]).cross(changed.normal).stableNormalized();
  };
  return outward.emplace(Outward{of_side(0), of_side(1), of_side(2)});
}

// The quick answer: q but for its corner j, which is the corner i of the other, lies on one side of the
// other's plane, or beyond one of its sides (that end in the corner).
bool CollapseTrial::is_beyond(const ChangedTriangle& changed, const Corners& q, int i, int j) {
  const double margin = kLeastGapMm * changed.normal.norm();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int l = 0; l < 3; ++l) {
    if (l == j) continue;
    const double height = changed.normal.dot(q[l] - changed.corners[0]);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  if (low > margin || high < -margin) return true;
  const Outward& outward = outward_of(changed);
  for (int k = 0; k < 3; ++k) {
    if (i >= 0 && i != k && i != (k + 1) % 3) continue;
    double beyond = std::numeric_limits<double>::infinity();
    for (int l = 0; l < 3; ++l)
      if (l != j) beyond = std::min(beyond, outward[k].dot(q[l] - changed.corners[k]));
    if (beyond > kLeastGapMm) return true;
  }
  return false;
}

}  // namespace skinframe
