// SPDX-License-Identifier: GPL-3.0-or-later
// Distance to and side of a closed surface, by CGAL's tree of triangles: the check's own, apart from the
// level sets that the export was made with.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe::check {

class Surface {
 public:
  explicit Surface(const TriangleMesh& closed_mesh);
  ~Surface();
  Surface(Surface&&) noexcept;

  // Depth below the surface in mm: positive inside, negative outside. Where the surface crosses itself and
  // encloses a place twice, that is inside.
  double depth_mm(const Eigen::Vector3d& point_mm) const;
  Eigen::Vector3d nearest(const Eigen::Vector3d& point_mm) const;
  // Unsigned, and cheaper.
  double distance_mm(const Eigen::Vector3d& point_mm) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skinframe::check
