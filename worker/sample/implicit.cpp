// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sample/implicit.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace skinframe {

Implicit sphere(const Point& centre, double radius) {
  return [=](const Point& p) { return (p - centre).norm() - radius; };
}

Implicit capsule(const Point& a, const Point& b, double radius) {
  return [=](const Point& p) {
    const Point ab = b - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    return (p - (a + t * ab)).norm() - radius;
  };
}

Implicit upright_cylinder(const Eigen::Vector2d& axis, double radius, double z_low, double z_high,
                          double rounding) {
  return [=](const Point& p) {
    const double out = (p.head<2>() - axis).norm() - (radius - rounding);
    const double above = std::abs(p.z() - (z_low + z_high) / 2) - ((z_high - z_low) / 2 - rounding);
    return std::min(std::max(out, above), 0.0) + std::hypot(std::max(out, 0.0), std::max(above, 0.0)) -
           rounding;
  };
}

Implicit rounded_box(const Point& low, const Point& high, double rounding) {
  const Point middle = (low + high) / 2;
  const Point half = (high - low) / 2 - Point::Constant(rounding);
  return [=](const Point& p) {
    const Point q = (p - middle).cwiseAbs() - half;
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - rounding;
  };
}

Implicit upright_torus(const Point& centre, double ring_radius, double tube_radius) {
  return [=](const Point& p) {
    const Point q = p - centre;
    return std::hypot(std::hypot(q.x(), q.z()) - ring_radius, q.y()) - tube_radius;
  };
}

Implicit ellipsoid(const Point& centre, const Point& semi_axes) {
  return [=](const Point& p) {
    const Point q = p - centre;
    const double k0 = q.cwiseQuotient(semi_axes).norm();
    const double k1 = q.cwiseQuotient(semi_axes.cwiseProduct(semi_axes)).norm();
    // First-order distance; at the centre, where it has no gradient, the shortest way out.
    return k1 > 0 ? k0 * (k0 - 1) / k1 : -semi_axes.minCoeff();
  };
}

Implicit join(Implicit a, Implicit b, double fillet) {
  return [a = std::move(a), b = std::move(b), fillet](const Point& p) {
    const double da = a(p), db = b(p);
    if (fillet <= 0) return std::min(da, db);
    const double blend = std::max(fillet - std::abs(da - db), 0.0) / fillet;
    return std::min(da, db) - blend * blend * fillet / 4;
  };
}

Implicit cut(Implicit body, Implicit tool) {
  return [body = std::move(body), tool = std::move(tool)](const Point& p) {
    return std::max(body(p), -tool(p));
  };
}

Implicit stand_on_plate(Implicit body) {
  return [body = std::move(body)](const Point& p) { return std::max(body(p), -p.z()); };
}

}  // namespace skinframe
