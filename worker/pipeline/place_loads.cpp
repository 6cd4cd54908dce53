// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/place_loads.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <numeric>

namespace skinframe {
namespace {

constexpr double kPlaceBandMm = 1.0;         // surface this near to the furthest point belongs to the place
constexpr double kPatchCellMm = 1.0;         // a patch is summed over cells of about this size
constexpr double kMaxDistanceToSkinMm = 10;  // beyond the patch's radius, from a given point to the skin

Eigen::Vector3d direction_of(Place place) {
  switch (place) {
    case Place::kTop:
      return {0, 0, 1};
    case Place::kBottom:
      return {0, 0, -1};
    case Place::kLeft:
      return {-1, 0, 0};
    case Place::kRight:
      return {1, 0, 0};
    case Place::kFront:
      return {0, -1, 0};
    case Place::kBack:
      return {0, 1, 0};
  }
  SKINFRAME_CHECK(false);
}

struct Spot {
  int triangle = -1;
  Eigen::Vector3d weights;  // barycentric
  double distance_mm = std::numeric_limits<double>::infinity();
};

// Nearest point of a triangle, by regions (Ericson, Real-Time Collision Detection, 5.1.5), as barycentric
// weights.
Eigen::Vector3d nearest_weights(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

Spot nearest_spot(const Frame& frame, const Eigen::Vector3d& point) {
  Spot best;
  for (std::size_t t = 0; t < frame.skin_triangles.size(); ++t) {
    const auto& tri = frame.skin_triangles[t];
    const Eigen::Vector3d &a = frame.nodes_mm[tri[0]], &b = frame.nodes_mm[tri[1]],
                          &c = frame.nodes_mm[tri[2]];
    const Eigen::Vector3d w = nearest_weights(point, a, b, c);
    const double distance = (w[0] * a + w[1] * b + w[2] * c - point).norm();
    if (distance < best.distance_mm) best = {static_cast<int>(t), w, distance};
  }
  return best;
}

void spread(const Load& load, const Eigen::Vector3d& centre, const Spot& nearest, const Frame& frame,
            LoadCase* out) {
  // Share of the patch's area that falls to each node. Cells are the k^2 congruent parts of a triangle.
  std::vector<std::pair<int, double>> shares;
  double area = 0;
  for (const auto& tri : frame.skin_triangles) {
    const Eigen::Vector3d p[3] = {frame.nodes_mm[tri[0]], frame.nodes_mm[tri[1]], frame.nodes_mm[tri[2]]};
    const Eigen::Vector3d w = nearest_weights(centre, p[0], p[1], p[2]);
    if ((w[0] * p[0] + w[1] * p[1] + w[2] * p[2] - centre).norm() > load.radius_mm) continue;
    const double edge = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    const int k = std::clamp(static_cast<int>(edge / kPatchCellMm), 1, 64);
    const double cell = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm() / (k * k);
    double weight[3] = {0, 0, 0};
    for (int i = 0; i < k; ++i)
      for (int j = 0; i + j < k; ++j)
        for (int half = 0; half < (i + j < k - 1 ? 2 : 1); ++half) {
          const double u = (i + (half == 0 ? 1.0 : 2.0) / 3) / k, v = (j + (half == 0 ? 1.0 : 2.0) / 3) / k;
          if (((1 - u - v) * p[0] + u * p[1] + v * p[2] - centre).norm() > load.radius_mm) continue;
          weight[0] += cell * (1 - u - v);
          weight[1] += cell * u;
          weight[2] += cell * v;
        }
    for (int c = 0; c < 3; ++c)
      if (weight[c] > 0) {
        shares.emplace_back(tri[c], weight[c]);
        area += weight[c];
      }
  }
  if (area > 0) {
    for (const auto& [node, weight] : shares) out->force_n[node] += load.force_n * (weight / area);
    return;
  }
  // A patch smaller than a cell, or one that the chords of the skin pass by: the nearest point carries it
  // all.
  for (int c = 0; c < 3; ++c)
    out->force_n[frame.skin_triangles[nearest.triangle][c]] += load.force_n * nearest.weights[c];
}

}  // namespace

Eigen::Vector3d place_point_mm(const Solid& solid, Place place) {
  const TriangleMesh& mesh = solid.mesh();
  const Eigen::Vector3d direction = direction_of(place);
  std::size_t furthest = 0;
  for (std::size_t i = 1; i < mesh.vertices.size(); ++i)
    if (direction.dot(mesh.vertices[i]) > direction.dot(mesh.vertices[furthest])) furthest = i;
  const double band = direction.dot(mesh.vertices[furthest]) - kPlaceBandMm;

  // Vertices in the band that triangles of the band join to the furthest one.
  std::vector<int> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const auto inside = [&](int v) { return direction.dot(mesh.vertices[v]) >= band; };
  for (const auto& t : mesh.triangles)
    if (inside(t[0]) && inside(t[1]) && inside(t[2])) {
      root[find(t[1])] = find(t[0]);
      root[find(t[2])] = find(t[0]);
    }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0;
  for (const auto& t : mesh.triangles) {
    if (!inside(t[0]) || !inside(t[1]) || !inside(t[2]) || find(t[0]) != find(static_cast<int>(furthest)))
      continue;
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double w = (b - a).cross(c - a).norm();
    sum += w * (a + b + c) / 3;
    area += w;
  }
  return area > 0 ? Eigen::Vector3d(sum / area) : mesh.vertices[furthest];
}

std::vector<StressLoad> loads_at_points(const std::vector<Load>& loads, const Solid& solid) {
  std::vector<StressLoad> out;
  for (const Load& load : loads) {
    const Eigen::Vector3d point = std::holds_alternative<Place>(load.where)
                                      ? place_point_mm(solid, std::get<Place>(load.where))
                                      : std::get<Eigen::Vector3d>(load.where);
    out.push_back({load.name, point, load.force_n, load.radius_mm});
  }
  return out;
}

Result<PlacedLoads> place_loads(const std::vector<Load>& loads, const Solid& solid, const Frame& frame) {
  const auto empty_case = [&](const std::string& name) {
    return LoadCase{name, true, std::vector<Eigen::Vector3d>(frame.nodes_mm.size(), Eigen::Vector3d::Zero())};
  };
  PlacedLoads placed{{empty_case(kSelfWeight)}, {}};
  std::vector<LoadCase>& cases = placed.cases;
  for (const Load& load : loads) {
    const bool at_place = std::holds_alternative<Place>(load.where);
    const Eigen::Vector3d centre =
        at_place ? place_point_mm(solid, std::get<Place>(load.where)) : std::get<Eigen::Vector3d>(load.where);
    const Spot nearest = nearest_spot(frame, centre);
    if (at_place && nearest.distance_mm > load.radius_mm + kMaxDistanceToSkinMm)
      placed.warnings.push_back(
          fmt::format("load \"{}\": the object is thinner than two skins where it acts, and the frame "
                      "carries it {:.1f} mm away",
                      load.name, nearest.distance_mm));
    if (!at_place && nearest.distance_mm > load.radius_mm + kMaxDistanceToSkinMm)
      return invalid_input(
          fmt::format("load \"{}\": the point ({:g}, {:g}, {:g}) is {:.1f} mm from the surface; the object "
                      "stands on z = 0, centred in "
                      "x and y, and measures {:.1f} x {:.1f} x {:.1f} mm",
                      load.name, centre.x(), centre.y(), centre.z(), nearest.distance_mm,
                      solid.box().extent().x(), solid.box().extent().y(), solid.box().extent().z()));
    auto it =
        std::find_if(cases.begin(), cases.end(), [&](const LoadCase& c) { return c.name == load.name; });
    if (it == cases.end()) it = cases.insert(cases.end(), empty_case(load.name));
    spread(load, centre, nearest, frame, &*it);
  }
  return placed;
}

}  // namespace skinframe
