// SPDX-License-Identifier: GPL-3.0-or-later
// Exact questions to a closed surface: the nearest point, inside or not, the way out. A tree of its
// triangles. Reads from many threads at once are safe.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);  // triangles without area are left out
  ~TriangleTree();
  TriangleTree(const TriangleTree&) = delete;
  TriangleTree& operator=(const TriangleTree&) = delete;

  Eigen::Vector3d nearest(const Eigen::Vector3d& point_mm) const;
  double distance_mm(const Eigen::Vector3d& point_mm) const;
  // distance_mm(point) <= most_mm, without looking for the nearest.
  bool is_within(const Eigen::Vector3d& point_mm, double most_mm) const;
  // By the crossings of a ray, each with its sign: shells that overlap count as one.
  bool is_inside(const Eigen::Vector3d& point_mm) const;
  // Length of the ray until it first leaves through a triangle from behind; most_mm where it does not before
  // that.
  double way_out(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& unit_direction, double most_mm) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skinframe
