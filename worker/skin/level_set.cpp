// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/level_set.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace skinframe {
namespace {

// A flat wall that runs through the grid's points leaves there the sign to rounding, and its surface becomes
// a crumpled sheet of triangles back to back. A thousandth of a voxel deeper it does not.
constexpr double kOffLatticeInVoxels = 1e-3;
// Below the surface, of a point of it. Beside sharp edges interpolation alone is off by more than half a
// voxel.
constexpr double kHiddenInVoxels = 0.75;

using Corners = std::array<openvdb::Vec3d, 3>;

// Whether it holds at one of points of the triangle that are about the spacing apart: rows along its longest
// side, so that slivers have as many as they are long.
template <class Holds>
bool holds_somewhere(Corners corners, double spacing_mm, Holds holds) {
  for (int turn = 0; turn < 2; ++turn) {
    const auto& [a, b, c] = corners;
    if ((b - a).lengthSqr() >= std::max((c - b).lengthSqr(), (a - c).lengthSqr())) break;
    corners = {b, c, a};
  }
  const auto& [a, b, c] = corners;
  const auto count = [&](double length_mm) { return std::max(1.0, std::ceil(length_mm / spacing_mm)); };
  const double base = (b - a).length();
  const double rows = base > 0.0 ? count((b - a).cross(c - a).length() / base) : 1.0;
  for (double row = 0.5; row < rows; ++row) {
    const openvdb::Vec3d from = a + (c - a) * (row / rows), to = b + (c - b) * (row / rows);
    const double points = count((to - from).length());
    for (double point = 0.5; point < points; ++point)
      if (holds(from + (to - from) * (point / points))) return true;
  }
  return false;
}

// Triangles that the grid does not see, be it in a part only: OpenVDB takes surface for a fold within the
// material, and drops it, where no point of the grid about it is outside. So it is with a void narrower than
// a voxel, and with what of a surface that crosses itself lies within. One that is named though the grid sees
// it costs time and changes nothing.
std::vector<openvdb::Vec3I> hidden_triangles(const openvdb::FloatGrid& grid,
                                             const std::vector<openvdb::Vec3s>& points,
                                             const std::vector<openvdb::Vec3I>& triangles) {
  const double voxel = grid.voxelSize()[0];
  std::vector<char> is_hidden(triangles.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 256), [&](const auto& range) {
    const auto values = grid.getConstAccessor();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto& t = triangles[i];
      is_hidden[i] = holds_somewhere({points[t[0]], points[t[1]], points[t[2]]}, voxel, [&](const auto& p) {
        return openvdb::tools::BoxSampler::sample(values, grid.transform().worldToIndex(p)) <
               -kHiddenInVoxels * voxel;
      });
    }
  });
  std::vector<openvdb::Vec3I> hidden;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (is_hidden[i]) hidden.push_back(triangles[i]);
  return hidden;
}

double just_below(const openvdb::FloatGrid& grid, double iso_mm) {
  return iso_mm - kOffLatticeInVoxels * grid.voxelSize()[0];
}

// Takes what the mesher has. OpenVDB winds its faces clockwise seen from the larger values: turned about
// here.
TriangleMesh triangles_of(openvdb::tools::VolumeToMesh& mesher) {
  TriangleMesh mesh;
  mesh.vertices.resize(mesher.pointListSize());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.vertices.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const openvdb::Vec3s& p = mesher.pointList()[i];
      mesh.vertices[i] = {p.x(), p.y(), p.z()};
    }
  });
  mesher.pointList().reset();  // before the triangles take as much
  // Single triangles of all pools first, then the quads.
  const std::size_t pools = mesher.polygonPoolListSize();
  std::vector<std::size_t> first_single(pools + 1, 0), first_quad(pools + 1, 0);
  for (std::size_t n = 0; n < pools; ++n) {
    first_single[n + 1] = first_single[n] + mesher.polygonPoolList()[n].numTriangles();
    first_quad[n + 1] = first_quad[n] + mesher.polygonPoolList()[n].numQuads();
  }
  mesh.triangles.resize(first_single[pools] + 2 * first_quad[pools]);
  const auto set = [&](std::size_t t, unsigned a, unsigned b, unsigned c) {
    mesh.triangles[t] = {static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)};
  };
  const auto point = [&](unsigned i) { return openvdb::Vec3s(mesh.vertices[i].data()); };  // floats again
  const auto squared = [&](unsigned i, unsigned j) { return (point(i) - point(j)).lengthSqr(); };
  tbb::parallel_for(std::size_t{0}, pools, [&](std::size_t n) {
    auto& pool = mesher.polygonPoolList()[n];
    for (std::size_t i = 0; i < pool.numTriangles(); ++i) {
      const auto& t = pool.triangle(i);
      set(first_single[n] + i, t[2], t[1], t[0]);
    }
    for (std::size_t i = 0; i < pool.numQuads(); ++i) {
      const auto& q = pool.quad(i);
      const std::size_t t = first_single[pools] + 2 * (first_quad[n] + i);
      if (squared(q[0], q[2]) <= squared(q[1], q[3])) {
        set(t, q[2], q[1], q[0]);
        set(t + 1, q[3], q[2], q[0]);
      } else {
        set(t, q[1], q[0], q[3]);
        set(t + 1, q[3], q[2], q[1]);
      }
    }
    pool.clearQuads();
    pool.clearTriangles();
  });
  return mesh;
}

}  // namespace

openvdb::FloatGrid::Ptr distance_grid(const TriangleMesh& mesh, double voxel_mm, double outer_voxels,
                                      double inner_voxels) {
  openvdb::initialize();
  std::vector<openvdb::Vec3s> points;
  points.reserve(mesh.vertices.size());
  for (const auto& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<openvdb::Vec3I> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel_mm);
  auto grid = openvdb::tools::meshToSignedDistanceField<openvdb::FloatGrid>(
      *transform, points, triangles, {}, static_cast<float>(outer_voxels), static_cast<float>(inner_voxels));
  const auto hidden = hidden_triangles(*grid, points, triangles);
  if (hidden.empty()) return grid;
  auto beside = openvdb::tools::meshToUnsignedDistanceField<openvdb::FloatGrid>(
      *transform, points, hidden, {}, static_cast<float>(inner_voxels));
  for (auto it = beside->beginValueOn(); it; ++it) it.setValue(-*it);
  openvdb::tools::changeBackground(beside->tree(), -static_cast<float>(inner_voxels * voxel_mm));
  openvdb::tools::compMax(*grid, *beside);
  return grid;
}

TriangleMesh iso_surface(const openvdb::FloatGrid& grid, double iso_mm) {
  openvdb::tools::VolumeToMesh mesher(just_below(grid, iso_mm), 0.0);
  mesher(grid);
  return triangles_of(mesher);
}

TriangleMesh iso_surface(openvdb::FloatGrid::Ptr&& grid, double iso_mm) {
  openvdb::tools::VolumeToMesh mesher(just_below(*grid, iso_mm), 0.0);
  mesher(*grid);
  grid.reset();
  return triangles_of(mesher);
}

}  // namespace skinframe
