// SPDX-License-Identifier: GPL-3.0-or-later
// A body: a triangle mesh that is known to bound a volume. It can only be made closed, so nobody who is
// given one asks again.
//
// Invariants:
//  1. Every directed edge stands in exactly one triangle, and its reverse in exactly one other: closed,
//     edge-manifold, consistently oriented. No triangle names a vertex twice.
//  2. The triangles look outward: the volume is positive (a cavity's shell, inside another, looks inward).
//  3. Every coordinate is exactly representable as a float, and no two vertices coincide: a binary STL of
//     it, welded by equality, is the same mesh.
//  4. Every vertex is used by a triangle.
// Not promised: freedom from self-intersection (published models have slight ones), and
// one umbrella per vertex (two cones that touch at their tips share one).
// Units: mm.
#pragma once

#include <Eigen/Core>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"

namespace skinframe {

class Solid {
 public:
  // Rounds to float, welds what coincides, drops triangles that collapse by it, and checks the invariants.
  // Error: kInvalidInput names the first edge or the volume that breaks one.
  static Result<Solid> make(TriangleMesh mesh);

  const TriangleMesh& mesh() const { return mesh_; }
  double volume_mm3() const { return volume_mm3_; }
  double area_mm2() const { return area_mm2_; }
  const BoundingBox& box() const { return box_; }
  const Eigen::Vector3d& centroid_mm() const { return centroid_mm_; }  // of the volume

 private:
  Solid() = default;

  TriangleMesh mesh_;
  BoundingBox box_;
  double volume_mm3_ = 0;
  double area_mm2_ = 0;
  Eigen::Vector3d centroid_mm_ = Eigen::Vector3d::Zero();
};

}  // namespace skinframe
