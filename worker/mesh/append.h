// SPDX-License-Identifier: GPL-3.0-or-later
// Several bodies as one list of triangles; nothing is welded or united.
#pragma once

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

inline void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
}

}  // namespace skinframe
