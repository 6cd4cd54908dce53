// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sample/mesh_body.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace skinframe {
namespace {

constexpr double kBandVoxels = 3;

// Grid points stand half a voxel off the plane z = 0: a flat foot between two layers is met exactly, and no
// sample of it is zero.
Point to_mm(const openvdb::Vec3d& index, double voxel) {
  return voxel * (Point(index.x(), index.y(), index.z()) + Point::Constant(0.5));
}

openvdb::FloatGrid::Ptr sample(const Body& body) {
  const double band = kBandVoxels * body.voxel_mm;
  auto grid = openvdb::FloatGrid::create(static_cast<float>(band));
  auto values = grid->getAccessor();
  const Point low = body.box.min / body.voxel_mm, high = body.box.max / body.voxel_mm;
  const openvdb::Coord first(static_cast<int>(std::floor(low.x())), static_cast<int>(std::floor(low.y())),
                             static_cast<int>(std::floor(low.z())));
  const openvdb::Coord last(static_cast<int>(std::ceil(high.x())), static_cast<int>(std::ceil(high.y())),
                            static_cast<int>(std::ceil(high.z())));
  for (int i = first.x(); i <= last.x(); ++i) {
    for (int j = first.y(); j <= last.y(); ++j) {
      for (int k = first.z(); k <= last.z(); ++k) {
        const double d = body.surface(to_mm(openvdb::Vec3d(i, j, k), body.voxel_mm));
        if (d >= band) continue;
        const openvdb::Coord at(i, j, k);
        if (d > -band)
          values.setValueOn(at, static_cast<float>(d));
        else
          values.setValueOff(at, static_cast<float>(-band));
      }
    }
  }
  return grid;
}

}  // namespace

TriangleMesh mesh_body(const Body& body) {
  openvdb::initialize();
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*sample(body), points, quads, 0.0);
  TriangleMesh mesh;
  mesh.vertices.reserve(points.size());
  for (const openvdb::Vec3s& p : points) mesh.vertices.push_back(to_mm(openvdb::Vec3d(p), body.voxel_mm));
  mesh.triangles.reserve(2 * quads.size());
  for (const openvdb::Vec4I& quad : quads) {
    const std::array<int, 4> q{static_cast<int>(quad[0]), static_cast<int>(quad[1]),
                               static_cast<int>(quad[2]), static_cast<int>(quad[3])};
    const double d02 = (mesh.vertices[q[0]] - mesh.vertices[q[2]]).squaredNorm();
    const double d13 = (mesh.vertices[q[1]] - mesh.vertices[q[3]]).squaredNorm();
    const int shift = d02 <= d13 ? 0 : 1;
    const auto at = [&](int corner) { return q[(corner + shift) % 4]; };
    mesh.triangles.push_back({at(0), at(1), at(2)});
    mesh.triangles.push_back({at(0), at(2), at(3)});
  }
  if (signed_volume(mesh) < 0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

}  // namespace skinframe
