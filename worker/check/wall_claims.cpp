// SPDX-License-Identifier: GPL-3.0-or-later
// The wall between M and the cavity, measured along rays: from points spread over M, straight inwards. A ray
// that comes into the cavity before it has gone the skin's thickness less a voxel, and before it leaves M,
// has found a wall that is too thin. The ray's way is never shorter than the wall.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "worker/check/claims.h"
#include "worker/check/near_boxes.h"

namespace skinframe::check {
namespace {

constexpr int kRays = 40'000;
constexpr double kStartMm = 1e-3;  // behind the surface, so that a ray does not meet the triangle it leaves

struct Ray {
  Eigen::Vector3d from, to;
  double cavity_mm = std::numeric_limits<double>::infinity();
  double outside_mm = std::numeric_limits<double>::infinity();
};

// Evenly over the area: one ray in each of kRays equal shares of it, at a random place there; seeded, so it
// is the same every time.
std::vector<Ray> rays_into(const TriangleMesh& mesh, std::size_t triangles, double length_mm) {
  std::vector<double> areas(triangles);
  double total = 0.0;
  const auto normal_of = [&](std::size_t t) -> Eigen::Vector3d {
    const auto& [a, b, c] = mesh.triangles[t];
    return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
  };
  for (std::size_t t = 0; t < triangles; ++t) total += areas[t] = normal_of(t).norm();
  std::vector<Ray> rays;
  if (!(total > 0.0)) return rays;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double passed = 0.0;
  std::size_t t = 0;
  for (int i = 0; i < kRays; ++i) {
    const double wanted = total * (i + unit(random)) / kRays;
    while (t + 1 < triangles && passed + areas[t] < wanted) passed += areas[t++];
    if (!(areas[t] > 0.0)) continue;
    const double root = std::sqrt(unit(random)), share = unit(random);
    const auto& [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3d at = (1 - root) * mesh.vertices[a] + root * (1 - share) * mesh.vertices[b] +
                               root * share * mesh.vertices[c];
    const Eigen::Vector3d inward = -normal_of(t) / areas[t];
    rays.push_back({at + kStartMm * inward, at + length_mm * inward});
  }
  return rays;
}

// Way from the ray's start to the triangle, in mm; infinite where it is missed. Moller and Trumbore 1997.
double way_to(const Ray& ray, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d along = ray.to - ray.from, u = b - a, v = c - a, p = along.cross(v);
  const double determinant = u.dot(p);
  if (determinant == 0.0) return kMiss;
  const Eigen::Vector3d s = ray.from - a, q = s.cross(u);
  const double x = s.dot(p) / determinant, y = along.dot(q) / determinant, w = v.dot(q) / determinant;
  return x < 0.0 || y < 0.0 || x + y > 1.0 || w < 0.0 || w > 1.0 ? kMiss : w * along.norm();
}

}  // namespace

void claim_walls(const ExportedPrinter& result, Verdict* verdict) {
  const TriangleMesh& mesh = *result.merged;
  const std::size_t own = std::min(result.solid_triangles, mesh.triangles.size());
  if (own == mesh.triangles.size()) return;  // no cavity
  const double least_mm = result.skin_thickness_mm - result.voxel_mm;
  auto rays = rays_into(mesh, own, result.skin_thickness_mm);
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(rays.size() + mesh.triangles.size());
  for (const Ray& ray : rays) boxes.emplace_back(ray.from.cwiseMin(ray.to), ray.from.cwiseMax(ray.to));
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    boxes.emplace_back(p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r));
  }
  for_each_overlap(boxes, [&](int i, int j) {
    if (i >= static_cast<int>(rays.size()) || j < static_cast<int>(rays.size())) return;
    Ray& ray = rays[i];
    const std::size_t t = j - rays.size();
    const auto& [a, b, c] = mesh.triangles[t];
    // The wall of a drain hole ends what is there to be thin.
    if (t >= own && result.drain && in_a_hole(*result.drain, mesh.vertices[a]) &&
        in_a_hole(*result.drain, mesh.vertices[b]) && in_a_hole(*result.drain, mesh.vertices[c]))
      return;
    double& nearest = t < own ? ray.outside_mm : ray.cavity_mm;
    nearest = std::min(nearest, way_to(ray, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  });
  int thin = 0;
  double thinnest = std::numeric_limits<double>::infinity();
  for (const Ray& ray : rays) {
    if (ray.cavity_mm >= ray.outside_mm) continue;  // M itself is thinner, or the wall is not found so near
    const double wall = ray.cavity_mm + kStartMm;
    thinnest = std::min(thinnest, wall);
    thin += wall < least_mm;
  }
  verdict->claims.push_back(
      {"walls", thin == 0 && !rays.empty(),
       fmt::format(
           "{} of {} rays into the wall find it thinner than {:.3f} mm (skin {:.3f} mm less a voxel of "
           "{:.3f} mm) where the solid is thicker; {}",
           thin, rays.size(), least_mm, result.skin_thickness_mm, result.voxel_mm,
           std::isfinite(thinnest) ? fmt::format("the thinnest {:.3f} mm", thinnest)
                                   : std::string("none as thin as the skin"))});
}

}  // namespace skinframe::check
