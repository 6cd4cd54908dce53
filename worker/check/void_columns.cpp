// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/void_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

namespace skinframe::check {
namespace {

constexpr double kOffset =
    0.3819660112501051;  // of a spacing: no column runs along an edge of the grid's making

struct Crossing {
  std::size_t column;
  double z;
  int step;  // +1 into the solid on the way up, -1 out of it
};

struct Interval {
  double low, high;
};

class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::size_t i, std::size_t j) { parent_[find(i)] = find(j); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

VoidVolumes flood_void(const TriangleMesh& mesh, double spacing) {
  VoidVolumes volumes;
  const BoundingBox box = bounding_box(mesh);
  const auto columns = [&](double extent) { return static_cast<std::size_t>(extent / spacing) + 3; };
  const std::size_t nx = columns(box.extent().x()), ny = columns(box.extent().y());
  const Eigen::Vector2d origin = box.min.head<2>() - Eigen::Vector2d::Constant((1.0 + kOffset) * spacing);
  volumes.columns = nx * ny;

  std::vector<Crossing> crossings;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    if (area == 0.0) continue;
    const double sign = area > 0.0 ? 1.0 : -1.0;
    // A side belongs to the triangle on one of its sides only, so that a column on it is crossed once.
    const auto within = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q, double x, double y) {
      const bool turned = p.x() > q.x() || (p.x() == q.x() && p.y() > q.y());
      const Eigen::Vector3d &u = turned ? q : p, &v = turned ? p : q;
      const double side = (v.x() - u.x()) * (y - u.y()) - (v.y() - u.y()) * (x - u.x());
      const bool left = side >= 0.0;  // the same answer for either triangle
      return (turned ? !left : left) == (sign > 0.0);
    };
    const auto first = [&](double least, double from) {
      return static_cast<std::size_t>(std::max(0.0, std::ceil((least - from) / spacing)));
    };
    const double high_x = std::max({a.x(), b.x(), c.x()}), high_y = std::max({a.y(), b.y(), c.y()});
    for (std::size_t i = first(std::min({a.x(), b.x(), c.x()}), origin.x());
         i < nx && origin.x() + i * spacing <= high_x; ++i)
      for (std::size_t j = first(std::min({a.y(), b.y(), c.y()}), origin.y());
           j < ny && origin.y() + j * spacing <= high_y; ++j) {
        const double x = origin.x() + i * spacing, y = origin.y() + j * spacing;
        if (!within(a, b, x, y) || !within(b, c, x, y) || !within(c, a, x, y)) continue;
        const double beta = ((x - a.x()) * (c - a).y() - (y - a.y()) * (c - a).x()) / area;
        const double gamma = ((b - a).x() * (y - a.y()) - (b - a).y() * (x - a.x())) / area;
        crossings.push_back(
            {i * ny + j, a.z() + beta * (b - a).z() + gamma * (c - a).z(), sign > 0.0 ? -1 : 1});
      }
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& p, const Crossing& q) {
    if (p.column != q.column) return p.column < q.column;
    return p.z != q.z ? p.z < q.z : p.step > q.step;
  });

  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<Interval> intervals;
  std::vector<std::size_t> begin(nx * ny + 1, 0);
  std::size_t at = 0;
  for (std::size_t column = 0; column < nx * ny; ++column) {
    begin[column] = intervals.size();
    int depth = 0;
    double low = -kFar;
    const std::size_t from = at;
    for (; at < crossings.size() && crossings[at].column == column; ++at) depth += crossings[at].step;
    if (depth != 0) {
      ++volumes.torn;
      continue;
    }
    for (std::size_t k = from; k < at; ++k) {
      const bool was_solid = depth > 0;
      depth += crossings[k].step;
      if (!was_solid && depth > 0 && crossings[k].z > low) intervals.push_back({low, crossings[k].z});
      if (was_solid && depth <= 0) low = crossings[k].z;
    }
    intervals.push_back({low, kFar});
  }
  begin[nx * ny] = intervals.size();

  Sets sets(intervals.size() + 1);
  const std::size_t outside = intervals.size();
  for (std::size_t k = 0; k < intervals.size(); ++k)
    if (intervals[k].low == -kFar || intervals[k].high == kFar) sets.unite(k, outside);
  const auto join = [&](std::size_t one, std::size_t other) {
    std::size_t p = begin[one], q = begin[other];
    while (p < begin[one + 1] && q < begin[other + 1]) {
      if (std::max(intervals[p].low, intervals[q].low) < std::min(intervals[p].high, intervals[q].high))
        sets.unite(p, q);
      (intervals[p].high < intervals[q].high ? p : q) += 1;
    }
  };
  for (std::size_t i = 0; i < nx; ++i)
    for (std::size_t j = 0; j < ny; ++j) {
      if (j + 1 < ny) join(i * ny + j, i * ny + j + 1);
      if (i + 1 < nx) join(i * ny + j, (i + 1) * ny + j);
    }
  std::map<std::size_t, VoidPart> parts;
  for (std::size_t column = 0; column < nx * ny; ++column)
    for (std::size_t k = begin[column]; k < begin[column + 1]; ++k) {
      const double length = intervals[k].high - intervals[k].low;
      if (!std::isfinite(length)) continue;
      const double volume = length * spacing * spacing;
      if (sets.find(k) == sets.find(outside)) {
        volumes.reached_mm3 += volume;
        continue;
      }
      volumes.sealed_mm3 += volume;
      VoidPart& part = parts[sets.find(k)];
      part.volume_mm3 += volume;
      part.centre_mm +=
          volume * Eigen::Vector3d(origin.x() + (column / ny) * spacing, origin.y() + (column % ny) * spacing,
                                   0.5 * (intervals[k].low + intervals[k].high));
    }
  for (auto& [set, part] : parts) {
    part.centre_mm /= part.volume_mm3;
    volumes.sealed.push_back(part);
  }
  std::stable_sort(volumes.sealed.begin(), volumes.sealed.end(),
                   [](const VoidPart& a, const VoidPart& b) { return a.volume_mm3 > b.volume_mm3; });
  return volumes;
}

}  // namespace skinframe::check
