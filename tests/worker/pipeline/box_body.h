// SPDX-License-Identifier: GPL-3.0-or-later
// A box of 20 x 30 x 40 mm on the plate, as a solid and as a skin triangulation of its own corners.
#pragma once

#include "worker/frame/frame.h"
#include "worker/solid/solid.h"

namespace skinframe::test {

inline TriangleMesh box_mesh() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1 ? 10 : -10, i & 2 ? 15 : -15, i & 4 ? 40 : 0);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline Solid box_solid() {
  auto solid = Solid::make(box_mesh());
  SKINFRAME_CHECK(solid.ok());
  return std::move(solid).value();
}

inline Frame box_frame() {
  const TriangleMesh mesh = box_mesh();
  Frame frame;
  frame.nodes_mm = mesh.vertices;
  frame.skin_node_count = 8;
  frame.skin_triangles = mesh.triangles;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (t[k] < t[(k + 1) % 3]) frame.struts.push_back({t[k], t[(k + 1) % 3], true});
  return frame;
}

}  // namespace skinframe::test
