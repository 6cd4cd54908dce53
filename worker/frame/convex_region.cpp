// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/convex_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "worker/frame/point_tree.h"
#include "worker/run/result.h"

namespace skinframe {
namespace {

constexpr double kMarginMm = 0.05;      // beside the radius: M1 between its samples
constexpr double kReachOfLength = 0.5;  // a node may go this share of the shortest of its struts in one pass,
constexpr double kLeastReachMm = 2.0;   // at least this,
constexpr double kMostReachMm = 10.0;   // at most that
constexpr double kOpening =
    0.25;  // radians kept between a strut's region and M1 at its skin end (required slope 0.2)

struct Segment {
  Eigen::Vector3d a, b;
  Eigen::Vector3d nearest(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d u = b - a;
    const double s = u.squaredNorm();
    return a + std::clamp(s > 0.0 ? (p - a).dot(u) / s : 0.0, 0.0, 1.0) * u;
  }
};

// A plane through the skin end that keeps p out: at the angle of p from the strut less the opening, so that
// the strut may lean towards p but not onto it. None when p lies behind the end.
std::optional<HalfSpace> plane_at_skin_end(const Eigen::Vector3d& end, const Eigen::Vector3d& other,
                                           const Eigen::Vector3d& p) {
  const Eigen::Vector3d u = (other - end).normalized(), to = p - end;
  const double along = to.dot(u);
  const Eigen::Vector3d side = to - along * u;
  if (side.norm() < 1e-9 || along <= 0.0) return std::nullopt;
  const double angle = std::max(0.0, std::atan2(side.norm(), along) - kOpening);
  HalfSpace plane;
  plane.normal = std::cos(angle) * side.normalized() - std::sin(angle) * u;
  plane.offset_mm = plane.normal.dot(end);
  return plane;
}

// The polytope about one strut, free of all samples within reach.
class Inflation {
 public:
  Inflation(const Frame& frame, const Strut& strut, double radius, double sampling_mm)
      : axis_{frame.nodes_mm[strut.a], frame.nodes_mm[strut.b]},
        skin_a_(strut.a < frame.skin_node_count),
        skin_b_(strut.b < frame.skin_node_count),
        radius_(radius),
        sampling_mm_(sampling_mm) {}

  std::vector<HalfSpace> around(const std::vector<Eigen::Vector3d>& samples) const {
    struct Obstacle {
      double distance;
      Eigen::Vector3d p, c;
    };
    std::vector<Obstacle> left;
    for (const auto& p : samples) {
      const Eigen::Vector3d c = axis_.nearest(p);
      left.push_back({(p - c).norm(), p, c});
    }
    std::stable_sort(left.begin(), left.end(),
                     [](const Obstacle& x, const Obstacle& y) { return x.distance < y.distance; });
    std::vector<HalfSpace> planes;
    std::vector<char> gone(left.size(), 0);
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (gone[i]) continue;
      const auto plane = supporting_plane(left[i].p, left[i].c, left[i].distance);
      if (!plane) continue;
      planes.push_back(*plane);
      for (std::size_t k = i; k < left.size(); ++k) {
        if (!gone[k] && plane->normal.dot(left[k].p) >= plane->normal.dot(left[i].p) - 1e-9) gone[k] = 1;
      }
    }
    return planes;
  }

 private:
  std::optional<HalfSpace> supporting_plane(const Eigen::Vector3d& p, const Eigen::Vector3d& c,
                                            double distance) const {
    if (distance < 1e-9) return std::nullopt;
    // The skin end's own place: the angle to a sample nearer than the sampling is noise.
    if (skin_a_ && (p - axis_.a).norm() < sampling_mm_) return std::nullopt;
    if (skin_b_ && (p - axis_.b).norm() < sampling_mm_) return std::nullopt;
    HalfSpace plane;
    plane.normal = (p - c) / distance;
    const double wanted = plane.normal.dot(p) - radius_ - kMarginMm;
    const double at_a = plane.normal.dot(axis_.a), at_b = plane.normal.dot(axis_.b);
    if (skin_a_ && at_a > wanted) return plane_at_skin_end(axis_.a, axis_.b, p);
    if (skin_b_ && at_b > wanted) return plane_at_skin_end(axis_.b, axis_.a, p);
    plane.offset_mm = std::max({wanted, at_a, at_b});
    return plane;
  }

  Segment axis_;
  bool skin_a_, skin_b_;
  double radius_;
  double sampling_mm_;
};

void add_box(std::vector<HalfSpace>& region, const Eigen::Vector3d& centre, double reach) {
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    region.push_back({axis, centre[i] + reach});
    region.push_back({-axis, -centre[i] + reach});
  }
}

// Planes that the box cannot reach say nothing.
bool cuts_box(const HalfSpace& plane, const Eigen::Vector3d& centre, double reach) {
  return plane.normal.dot(centre) + reach * plane.normal.cwiseAbs().sum() > plane.offset_mm;
}

}  // namespace

NodeRegions convex_regions(const Frame& frame, const std::vector<double>& radii_mm, const Skin& skin) {
  SKINFRAME_CHECK(radii_mm.size() == frame.struts.size());
  const auto is_internal = [&](int node) { return node >= frame.skin_node_count; };
  std::vector<double> reach(frame.nodes_mm.size(), kMostReachMm);
  for (const Strut& s : frame.struts) {
    if (s.is_skin) continue;
    const double share = std::max(kLeastReachMm, kReachOfLength * frame.length_mm(s));
    reach[s.a] = std::min(reach[s.a], share);
    reach[s.b] = std::min(reach[s.b], share);
  }
  NodeRegions regions(frame.nodes_mm.size());
  for (std::size_t i = frame.skin_node_count; i < regions.size(); ++i) {
    add_box(regions[i], frame.nodes_mm[i], reach[i]);
  }
  const PointTree samples(skin.inner_surface.vertices);
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    const Strut& s = frame.struts[j];
    if (s.is_skin || (!is_internal(s.a) && !is_internal(s.b))) continue;
    const Eigen::Vector3d a = frame.nodes_mm[s.a], b = frame.nodes_mm[s.b];
    // All that the strut can come near to while its ends stay in their boxes.
    const double move =
        std::sqrt(3.0) * std::max(is_internal(s.a) ? reach[s.a] : 0.0, is_internal(s.b) ? reach[s.b] : 0.0);
    const double ball = 0.5 * (b - a).norm() + move + radii_mm[j] + kMarginMm;
    std::vector<Eigen::Vector3d> near;
    for (int i : samples.within(0.5 * (a + b), ball)) {
      const Eigen::Vector3d& p = samples.point(i);
      if ((p - Segment{a, b}.nearest(p)).norm() <= move + radii_mm[j] + kMarginMm) near.push_back(p);
    }
    for (const HalfSpace& plane :
         Inflation(frame, s, radii_mm[j], skin.field.coarse_voxel_mm()).around(near)) {
      for (int node : {s.a, s.b}) {
        if (is_internal(node) && cuts_box(plane, frame.nodes_mm[node], reach[node]))
          regions[node].push_back(plane);
      }
    }
  }
  return regions;
}

}  // namespace skinframe
