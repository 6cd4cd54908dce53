// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/tet_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace skinframe {
namespace {

// The faces of a tetrahedron of positive volume, outward.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct Face {
  std::array<int, 3> key;  // ascending
  int tet;
  int side;
  bool operator<(const Face& other) const { return key != other.key ? key < other.key : tet < other.tet; }
};

std::vector<Face> sorted_faces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (int side = 0; side < 4; ++side) {
      std::array<int, 3> key;
      for (int k = 0; k < 3; ++k) key[k] = mesh.tets[t][kFaces[side][k]];
      std::sort(key.begin(), key.end());
      faces.push_back({key, static_cast<int>(t), side});
    }
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace

double tet_volume_mm3(const TetMesh& mesh, const std::array<int, 4>& tet) {
  const Eigen::Vector3d& a = mesh.vertices_mm[tet[0]];
  const Eigen::Vector3d b = mesh.vertices_mm[tet[1]] - a, c = mesh.vertices_mm[tet[2]] - a,
                        d = mesh.vertices_mm[tet[3]] - a;
  return b.cross(c).dot(d) / 6.0;
}

double volume_mm3(const TetMesh& mesh) {
  double sum = 0.0;
  for (const auto& tet : mesh.tets) sum += tet_volume_mm3(mesh, tet);
  return sum;
}

std::vector<std::array<int, 3>> boundary_of(const TetMesh& mesh) {
  std::vector<std::array<int, 3>> boundary;
  const auto faces = sorted_faces(mesh);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool twin_before = i > 0 && faces[i - 1].key == faces[i].key;
    const bool twin_after = i + 1 < faces.size() && faces[i + 1].key == faces[i].key;
    if (twin_before || twin_after) continue;
    const auto& tet = mesh.tets[faces[i].tet];
    const int* side = kFaces[faces[i].side];
    boundary.push_back({tet[side[0]], tet[side[1]], tet[side[2]]});
  }
  return boundary;
}

std::vector<int> face_components(const TetMesh& mesh) {
  std::vector<int> parent(mesh.tets.size());
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<int>(i);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto faces = sorted_faces(mesh);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].key == faces[i - 1].key) parent[find(faces[i].tet)] = find(faces[i - 1].tet);
  }
  std::vector<int> number(parent.size(), -1), component(parent.size());
  int next = 0;
  for (std::size_t i = 0; i < parent.size(); ++i) {
    int& n = number[find(static_cast<int>(i))];
    if (n < 0) n = next++;
    component[i] = n;
  }
  return component;
}

TetMesh largest_component(TetMesh mesh) {
  if (mesh.tets.empty()) return mesh;
  const auto component = face_components(mesh);
  std::vector<double> volume(*std::max_element(component.begin(), component.end()) + 1, 0.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    volume[component[t]] += tet_volume_mm3(mesh, mesh.tets[t]);
  const auto largest = std::max_element(volume.begin(), volume.end()) - volume.begin();
  std::vector<std::array<int, 4>> kept;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (component[t] == largest) kept.push_back(mesh.tets[t]);
  mesh.tets = std::move(kept);
  return mesh;
}

}  // namespace skinframe
