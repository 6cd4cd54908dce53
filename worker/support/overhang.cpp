// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/overhang.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace skinframe {
namespace {

using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kPointInSkins = 0.5;     // how deep a point to be held stands in the skin
constexpr double kLevelInPitches = 0.02;  // steps down that small count as level: what rounding makes of it
constexpr double kLeastDownward = 0.3;    // vertical part of a flat cell's normal: guards the area
constexpr double kStepInPitches = 0.25;
constexpr int kDirections[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};

// What a point is in; material is between.
enum class In { kAir, kMaterial, kCavity };

In in_what(const PrintedBody& body, const Vector3d& p) {
  const double depth = body.depth_mm(p);
  if (depth > body.skin_thickness_mm) return In::kCavity;
  return depth > 0.0 ? In::kMaterial : In::kAir;
}

}  // namespace

FlatSkin::FlatSkin(const PrintedBody& body, const BoundingBox& box, const PrintableLength& curve,
                   double pitch_mm)
    : into_skin_mm_(kPointInSkins * body.skin_thickness_mm) {
  const Vector3d extent = box.extent();
  pitch_mm_ = std::max(pitch_mm, std::sqrt(extent.x() * extent.y() / kMostColumns));
  columns_x_ = static_cast<int>(extent.x() / pitch_mm_) + 1;
  columns_y_ = static_cast<int>(extent.y() / pitch_mm_) + 1;
  const double flattest = self_supporting_angle(curve), step = kStepInPitches * pitch_mm_;
  const double fall = 1.0 / std::tan(flattest);
  const auto is_held_beside = [&](const Vector3d& at) {
    for (const auto& d : kDirections) {
      const double away = pitch_mm_ * std::hypot(d[0], d[1]);
      const Vector3d beside = at + Vector3d(d[0] * pitch_mm_, d[1] * pitch_mm_, -away * fall);
      if (beside.z() <= body.plate_z_mm || in_what(body, beside) == In::kMaterial) return true;
    }
    return false;
  };
  for (int c = 0; c < columns_x_ * columns_y_; ++c) {
    first_of_column_.push_back(static_cast<int>(cells_.size()));
    Vector3d p(box.min.x() + (c % columns_x_ + 0.5) * pitch_mm_,
               box.min.y() + (c / columns_x_ + 0.5) * pitch_mm_, body.plate_z_mm + 0.01 * step);
    In before = in_what(body, p);
    while (p.z() < box.max.z()) {
      // The depth is a distance: nothing changes nearer than that.
      const double depth = body.depth_mm(p), h = body.skin_thickness_mm;
      const double free_mm = depth > h ? depth - h : depth > 0.0 ? std::min(depth, h - depth) : -depth;
      p.z() += std::max(step, 0.9 * free_mm - step);
      const In now = in_what(body, p);
      if (now == In::kMaterial && before != In::kMaterial) {
        double low = p.z() - step, high = p.z();
        for (int k = 0; k < 6; ++k) {
          const double mid = 0.5 * (low + high);
          (in_what(body, {p.x(), p.y(), mid}) == In::kMaterial ? high : low) = mid;
        }
        const Vector3d at(p.x(), p.y(), high);
        const Vector3d out = body.outward(at);
        const double down = out.norm() > 0.0 ? std::abs(out.z()) / out.norm() : 1.0;
        if (high > body.plate_z_mm + step && !is_held_beside(at)) {
          const double slope = std::asin(std::clamp(down, 0.0, 1.0));
          cells_.push_back({at, before == In::kCavity, pitch_mm_ * pitch_mm_ / std::max(down, kLeastDownward),
                            0.5 * curve.length_mm(slope), kInfinite});
        }
      }
      before = now;
    }
  }
  first_of_column_.push_back(static_cast<int>(cells_.size()));

  // A flat cell beside material at its own height, or beside a cell that is held and no higher, is a pitch
  // away.
  std::vector<int> reached;
  for (int i = 0; i < static_cast<int>(cells_.size()); ++i) {
    for (const auto& d : kDirections) {
      const double away = pitch_mm_ * std::hypot(d[0], d[1]);
      const Vector3d beside =
          cells_[i].at_mm + Vector3d(2 * d[0] * pitch_mm_, 2 * d[1] * pitch_mm_, -away * fall);
      if (beside.z() > body.plate_z_mm && in_what(body, beside) != In::kMaterial) continue;
      cells_[i].way_mm = std::min(cells_[i].way_mm, away);
    }
    if (cells_[i].way_mm < kInfinite) reached.push_back(i);
  }
  spread(std::move(reached));
}

std::vector<int> FlatSkin::neighbours(int cell) const {
  std::vector<int> out;
  const FlatCell& from = cells_[cell];
  const auto column =
      std::upper_bound(first_of_column_.begin(), first_of_column_.end(), cell) - first_of_column_.begin() - 1;
  const int x = static_cast<int>(column) % columns_x_, y = static_cast<int>(column) / columns_x_;
  for (const auto& d : kDirections) {
    const int nx = x + d[0], ny = y + d[1];
    if (nx < 0 || ny < 0 || nx >= columns_x_ || ny >= columns_y_) continue;
    const int c = ny * columns_x_ + nx;
    for (int i = first_of_column_[c]; i < first_of_column_[c + 1]; ++i)
      if (cells_[i].is_roof == from.is_roof &&
          std::abs(cells_[i].at_mm.z() - from.at_mm.z()) <= 1.5 * pitch_mm_)
        out.push_back(i);
  }
  return out;
}

// Dijkstra from the cells whose way has become shorter.
void FlatSkin::spread(std::vector<int> changed) {
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const int i : changed) queue.push({cells_[i].way_mm, i});
  while (!queue.empty()) {
    const auto [way, i] = queue.top();
    queue.pop();
    if (way > cells_[i].way_mm) continue;
    for (const int j : neighbours(i)) {
      if (cells_[j].at_mm.z() < cells_[i].at_mm.z() - kLevelInPitches * pitch_mm_) continue;
      const double further = way + (cells_[j].at_mm - cells_[i].at_mm).norm();
      if (further >= cells_[j].way_mm) continue;
      cells_[j].way_mm = further;
      queue.push({further, j});
    }
  }
}

void FlatSkin::hold(const std::vector<Holder>& holders) {
  std::vector<int> changed;
  for (const Holder& holder : holders)
    for (int i = 0; i < static_cast<int>(cells_.size()); ++i) {
      if (cells_[i].is_roof != holder.is_within) continue;
      const Vector3d away = holder.at_mm - cells_[i].at_mm;
      if (std::abs(away.z()) > 4 * into_skin_mm_ + pitch_mm_) continue;
      const double beside = std::max(0.0, away.head<2>().norm() - holder.radius_mm);
      if (beside > pitch_mm_ || beside >= cells_[i].way_mm) continue;
      cells_[i].way_mm = beside;
      changed.push_back(i);
    }
  spread(std::move(changed));
}

std::vector<Vector3d> FlatSkin::points_to_hold(std::size_t most) {
  std::vector<Vector3d> points;
  while (points.size() < most) {
    int worst = -1;
    const auto is_worse = [&](const FlatCell& a, const FlatCell& b) {
      const double ea = a.way_mm / a.reach_mm, eb = b.way_mm / b.reach_mm;
      return ea > eb || (ea == eb && a.at_mm.z() < b.at_mm.z());
    };
    for (int i = 0; i < static_cast<int>(cells_.size()); ++i)
      if (cells_[i].beyond() && (worst < 0 || is_worse(cells_[i], cells_[worst]))) worst = i;
    if (worst < 0) break;
    points.push_back(cells_[worst].at_mm + Vector3d(0, 0, into_skin_mm_));
    cells_[worst].way_mm = 0.0;
    spread({worst});
  }
  return points;
}

Overhang FlatSkin::measure() const {
  Overhang sum;
  for (const FlatCell& cell : cells_) {
    (cell.is_roof ? sum.roof_mm2 : sum.underside_mm2) += cell.area_mm2;
    if (cell.beyond()) (cell.is_roof ? sum.roof_beyond_mm2 : sum.underside_beyond_mm2) += cell.area_mm2;
  }
  return sum;
}

std::vector<Holder> holders_of(const Frame& frame, const std::vector<double>& radii_mm,
                               const SupportPlan& plan, const PrintableLength& curve) {
  std::vector<Holder> holders;
  const double flattest = self_supporting_angle(curve);
  const auto add = [&](const Vector3d& a, const Vector3d& b, double radius_mm, bool is_within) {
    if (angle_from_vertical(a, b) <= flattest)
      holders.push_back({a.z() > b.z() ? a : b, radius_mm, is_within});
  };
  for (std::size_t j = 0; j < frame.struts.size(); ++j)
    if (!frame.struts[j].is_skin)
      add(frame.nodes_mm[frame.struts[j].a], frame.nodes_mm[frame.struts[j].b], radii_mm[j], true);
  for (const SupportStrut& s : plan.struts)
    add(node_mm(frame, plan, s.upper), node_mm(frame, plan, s.lower), s.radius_mm,
        s.kind == SupportKind::kInternal);
  return holders;
}

}  // namespace skinframe
