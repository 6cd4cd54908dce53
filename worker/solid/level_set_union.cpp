// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/level_set_union.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace skinframe {
namespace {

constexpr float kHalfBandVoxels = 3;
constexpr double kWantedTriangles = 500'000;

openvdb::FloatGrid::Ptr distance_of(const TriangleMesh& mesh, double voxel) {
  openvdb::initialize();
  std::vector<openvdb::Vec3s> points;
  points.reserve(mesh.vertices.size());
  for (const auto& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<openvdb::Vec3I> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  return openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
      *openvdb::math::Transform::createLinearTransform(voxel), points, triangles, kHalfBandVoxels);
}

TriangleMesh boundary_of(const openvdb::FloatGrid& grid) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, quads, 0.0);
  TriangleMesh mesh;
  mesh.vertices.reserve(points.size());
  for (const auto& p : points) mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  mesh.triangles.reserve(2 * quads.size());
  const auto add = [&](unsigned a, unsigned b, unsigned c) {
    mesh.triangles.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
  };
  // OpenVDB's quads run clockwise seen from outside; the shorter diagonal cuts them.
  for (const auto& q : quads) {
    const bool first = (points[q[0]] - points[q[2]]).lengthSqr() <= (points[q[1]] - points[q[3]]).lengthSqr();
    add(q[first ? 2 : 1], q[first ? 1 : 0], q[first ? 0 : 3]);
    add(q[3], q[2], q[first ? 0 : 1]);
  }
  return mesh;
}

}  // namespace

TriangleMesh level_set_union(const std::vector<LevelSetBody>& bodies, double voxel,
                             const RunContext& context) {
  openvdb::FloatGrid::Ptr united;
  for (const LevelSetBody& body : bodies) {
    if (context.cancelled()) return {};
    openvdb::FloatGrid::Ptr grid = distance_of(body.outer, voxel);
    for (const TriangleMesh& cavity : body.cavities)
      openvdb::tools::csgDifference(*grid, *distance_of(cavity, voxel));
    if (united) {
      openvdb::tools::csgUnion(*united, *grid);
    } else {
      united = std::move(grid);
    }
  }
  return united ? boundary_of(*united) : TriangleMesh{};
}

double shut_off_volume(const TriangleMesh& mesh, double voxel) {
  return signed_volume(boundary_of(*distance_of(mesh, voxel)));
}

double level_set_voxel(double area, double diagonal) {
  return std::clamp(std::sqrt(2 * area / kWantedTriangles), diagonal / 1500, diagonal / 200);
}

}  // namespace skinframe
