// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/place.h"

#include "worker/run/result.h"

namespace skinframe {

TriangleMesh scale_to_largest_edge(TriangleMesh mesh, double size_mm) {
  SKINFRAME_CHECK(size_mm > 0);
  const double largest = bounding_box(mesh).extent().maxCoeff();
  if (!(largest > 0)) return mesh;
  for (Eigen::Vector3d& v : mesh.vertices) v *= size_mm / largest;
  return mesh;
}

TriangleMesh turn_up(TriangleMesh mesh, Up up) {
  for (Eigen::Vector3d& v : mesh.vertices) {
    switch (up) {
      case Up::kX:
        v = Eigen::Vector3d(-v.z(), v.y(), v.x());
        break;
      case Up::kY:
        v = Eigen::Vector3d(v.x(), -v.z(), v.y());
        break;
      case Up::kZ:
        break;
    }
  }
  return mesh;
}

TriangleMesh put_on_plate(TriangleMesh mesh) {
  const BoundingBox box = bounding_box(mesh);
  const Eigen::Vector3d foot((box.min.x() + box.max.x()) / 2, (box.min.y() + box.max.y()) / 2, box.min.z());
  for (Eigen::Vector3d& v : mesh.vertices) v -= foot;
  return mesh;
}

}  // namespace skinframe
