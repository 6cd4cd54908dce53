// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle soup with shared vertices: what readers give and writers take. No invariant beyond
// "every index names a vertex and every coordinate is finite"; closedness is solid's business. Units: mm
// once scaled, file units before.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace skinframe {

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

struct BoundingBox {
  Eigen::Vector3d min = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Zero();
  Eigen::Vector3d extent() const { return max - min; }
};

BoundingBox bounding_box(const TriangleMesh& mesh);  // zero box for an empty mesh
double signed_volume(const TriangleMesh& mesh);      // divergence theorem; unit of the vertices, cubed
double surface_area(const TriangleMesh& mesh);
Eigen::Vector3d volume_centroid(const TriangleMesh& mesh);  // of a closed mesh

// Drops the vertices that no triangle uses, keeping the order of the others; returns how many.
std::size_t drop_unused_vertices(TriangleMesh& mesh);

}  // namespace skinframe
