// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/layers.h"

#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

using Eigen::Vector3d;

struct Rod {
  Vector3d a, b;
  double radius_mm;
  bool outside;  // of M; else within
};

// One layer: rows of cells, a byte each.
class Layer {
 public:
  Layer(const BoundingBox& box, double pitch_mm)
      : pitch_mm_(pitch_mm),
        origin_(box.min),
        nx_(static_cast<int>(box.extent().x() / pitch_mm) + 1),
        ny_(static_cast<int>(box.extent().y() / pitch_mm) + 1),
        cells_(static_cast<std::size_t>(nx_) * ny_, 0) {}

  void fill(const PrintedBody& body, double z) {
    const double h = body.skin_thickness_mm;
    for (int y = 0; y < ny_; ++y)
      for (int x = 0; x < nx_;) {
        const double depth = body.depth_mm(middle(x, y, z));
        const bool solid = depth > 0.0 && depth <= h;
        // The depth is a distance: what is so here is so as far as the nearest change.
        const double same = depth > h ? depth - h : depth > 0.0 ? std::min(depth, h - depth) : -depth;
        const int cells = std::max(1, static_cast<int>(0.9 * same / pitch_mm_));
        for (int k = 0; k < cells && x < nx_; ++k, ++x) cells_[index(x, y)] = solid;
      }
  }

  void add(const Rod& rod, const PrintedBody& body, double z) {
    // The part of the axis that is near the layer.
    const double rise = rod.b.z() - rod.a.z(), r = rod.radius_mm;
    double from = 0.0, to = 1.0;
    if (std::abs(rise) > 1e-9) {
      const double s = (z - r - rod.a.z()) / rise, t = (z + r - rod.a.z()) / rise;
      from = std::clamp(std::min(s, t), 0.0, 1.0);
      to = std::clamp(std::max(s, t), 0.0, 1.0);
    }
    if (z < std::min(rod.a.z(), rod.b.z()) - r || z > std::max(rod.a.z(), rod.b.z()) + r) return;
    const Vector3d p = rod.a + from * (rod.b - rod.a), q = rod.a + to * (rod.b - rod.a), d = rod.b - rod.a;
    const int x0 = column(std::min(p.x(), q.x()) - r, 0), x1 = column(std::max(p.x(), q.x()) + r, 0);
    const int y0 = column(std::min(p.y(), q.y()) - r, 1), y1 = column(std::max(p.y(), q.y()) + r, 1);
    for (int y = std::max(y0, 0); y <= std::min(y1, ny_ - 1); ++y)
      for (int x = std::max(x0, 0); x <= std::min(x1, nx_ - 1); ++x) {
        const Vector3d c = middle(x, y, z);
        const double s = std::clamp((c - rod.a).dot(d) / d.squaredNorm(), 0.0, 1.0);
        if ((c - rod.a - s * d).norm() <= r && (body.depth_mm(c) > 0.0) != rod.outside)
          cells_[index(x, y)] = 1;
      }
  }

  // Connected parts, each as the list of its cells.
  std::vector<std::vector<int>> parts() const {
    std::vector<char> seen(cells_.size(), 0);
    std::vector<std::vector<int>> all;
    for (int start = 0; start < static_cast<int>(cells_.size()); ++start) {
      if (!cells_[start] || seen[start]) continue;
      std::vector<int> part{start};
      seen[start] = 1;
      for (std::size_t k = 0; k < part.size(); ++k)
        around(part[k], 1, [&](int other) {
          if (!cells_[other] || seen[other]) return false;
          seen[other] = 1;
          part.push_back(other);
          return false;
        });
      all.push_back(std::move(part));
    }
    return all;
  }
  // Of a part's cells the one nearest to their mean.
  int most_central(const std::vector<int>& part) const {
    Vector3d mean = Vector3d::Zero();
    for (const int cell : part) mean += middle(cell, 0.0) / static_cast<double>(part.size());
    return *std::min_element(part.begin(), part.end(), [&](int a, int b) {
      return (middle(a, 0.0) - mean).squaredNorm() < (middle(b, 0.0) - mean).squaredNorm();
    });
  }
  bool holds_near(int cell, double reach_mm) const {
    const int cells = static_cast<int>(std::ceil(reach_mm / pitch_mm_));
    const int x = cell % nx_, y = cell / nx_;
    return around(cell, cells, [&](int other) {
      const int dx = other % nx_ - x, dy = other / nx_ - y;
      return cells_[other] != 0 && std::hypot(dx, dy) * pitch_mm_ <= reach_mm + 1e-9;
    });
  }
  Vector3d middle(int x, int y, double z) const {
    return {origin_.x() + (x + 0.5) * pitch_mm_, origin_.y() + (y + 0.5) * pitch_mm_, z};
  }
  Vector3d middle(int cell, double z) const { return middle(cell % nx_, cell / nx_, z); }

 private:
  int column(double at, int axis) const {
    return static_cast<int>(std::floor((at - origin_[axis]) / pitch_mm_));
  }
  int index(int x, int y) const { return y * nx_ + x; }
  template <class Ask>
  bool around(int cell, int cells, Ask ask) const {
    const int x = cell % nx_, y = cell / nx_;
    for (int ny = std::max(0, y - cells); ny <= std::min(ny_ - 1, y + cells); ++ny)
      for (int nx = std::max(0, x - cells); nx <= std::min(nx_ - 1, x + cells); ++nx)
        if (ask(index(nx, ny))) return true;
    return false;
  }

  double pitch_mm_;
  Vector3d origin_;
  int nx_, ny_;
  std::vector<char> cells_;
};

}  // namespace

Layers find_islands(const PrintedBody& body, const BoundingBox& box, const Frame& frame,
                    const std::vector<double>& radii_mm, const SupportPlan& plan,
                    const PrintableLength& curve, const LayerOptions& options) {
  std::vector<Rod> rods;
  for (std::size_t j = 0; j < frame.struts.size(); ++j)
    rods.push_back(
        {frame.nodes_mm[frame.struts[j].a], frame.nodes_mm[frame.struts[j].b], radii_mm[j], false});
  for (const SupportStrut& s : plan.struts)
    rods.push_back({node_mm(frame, plan, s.upper), node_mm(frame, plan, s.lower), s.radius_mm,
                    s.kind == SupportKind::kExternal});
  const double reach =
      std::max(options.height_mm * std::tan(self_supporting_angle(curve)), 1.5 * options.pitch_mm);
  Layers layers;
  Layer below(box, options.pitch_mm);
  for (double z = body.plate_z_mm + 0.5 * options.height_mm; z < box.max.z(); z += options.height_mm) {
    Layer layer(box, options.pitch_mm);
    layer.fill(body, z);
    for (const Rod& rod : rods) layer.add(rod, body, z);
    if (layers.count++ > 0)
      for (const std::vector<int>& part : layer.parts())
        if (std::none_of(part.begin(), part.end(), [&](int cell) { return below.holds_near(cell, reach); }))
          layers.islands.push_back({layer.middle(layer.most_central(part), z),
                                    static_cast<double>(part.size()) * options.pitch_mm * options.pitch_mm});
    below = std::move(layer);
  }
  return layers;
}

}  // namespace skinframe
