// SPDX-License-Identifier: GPL-3.0-or-later
// The frame: nodes V and struts E (Wang et al. 2013, section 3). Units: mm.
//
// Invariants:
//  1. Nodes 0 .. skin_node_count-1 are skin nodes and stand on M1; the rest are internal nodes inside M1.
//  2. The skin struts are exactly the edges of skin_triangles; each stands once.
//  3. 0 <= a, b < nodes.size(), a != b; no two struts join the same pair.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace skinframe {

struct Strut {
  int a = 0;
  int b = 0;
  bool is_skin = false;
};

struct Frame {
  std::vector<Eigen::Vector3d> nodes_mm;
  int skin_node_count = 0;
  std::vector<Strut> struts;
  std::vector<std::array<int, 3>> skin_triangles;  // counter-clockwise seen from outside

  double length_mm(const Strut& s) const { return (nodes_mm[s.b] - nodes_mm[s.a]).norm(); }
};

}  // namespace skinframe
