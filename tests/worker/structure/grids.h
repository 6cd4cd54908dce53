// SPDX-License-Identifier: GPL-3.0-or-later
// Structures with closed forms: chains of struts, rectangles and cylinders of shell.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "worker/structure/solve_structure.h"

namespace skinframe::test {

struct ShellGrid {
  Structure structure;
  int across = 0;  // cells in the second direction
  int node(int i, int j) const { return i * (across + 1) + j; }
};

// place(i / m, j / n) of an m x n grid; diagonals alternate where asked for.
template <class Place>
ShellGrid shell_grid(int m, int n, double thickness_mm, const ElasticMaterial& material, bool alternate,
                     Place place) {
  ShellGrid grid;
  grid.across = n;
  Structure& s = grid.structure;
  s.material = material;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j)
      s.nodes_mm.push_back(place(static_cast<double>(i) / m, static_cast<double>(j) / n));
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = grid.node(i, j), b = grid.node(i + 1, j), c = grid.node(i + 1, j + 1),
                d = grid.node(i, j + 1);
      if (alternate && (i + j) % 2 == 0) {
        s.shells.push_back({{a, b, d}, thickness_mm});
        s.shells.push_back({{b, c, d}, thickness_mm});
      } else {
        s.shells.push_back({{a, b, c}, thickness_mm});
        s.shells.push_back({{a, c, d}, thickness_mm});
      }
    }
  s.held.assign(s.nodes_mm.size(), kFree);
  return grid;
}

inline ShellGrid plate_grid(double length, double width, int m, int n, double thickness_mm,
                            const ElasticMaterial& material) {
  return shell_grid(m, n, thickness_mm, material, true,
                    [=](double u, double v) { return Eigen::Vector3d(length * u, width * v, 0); });
}

inline Structure chain(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int parts, double radius_mm,
                       const ElasticMaterial& material) {
  Structure s;
  s.material = material;
  for (int i = 0; i <= parts; ++i) s.nodes_mm.push_back(from + (to - from) * i / parts);
  for (int i = 0; i < parts; ++i) {
    StructureStrut strut;
    strut.nodes = {i, i + 1};
    strut.radius_mm = radius_mm;
    s.struts.push_back(strut);
  }
  s.held.assign(s.nodes_mm.size(), kFree);
  return s;
}

inline NodalColumns no_load(const Structure& s) {
  return NodalColumns::Zero(6 * static_cast<Eigen::Index>(s.nodes_mm.size()), 1);
}

inline StructureSolver factorised(const Structure& s) {
  RunContext context;
  auto solver = StructureSolver::factorise(s, context);
  SKINFRAME_CHECK(solver.ok());
  return std::move(solver).value();
}

}  // namespace skinframe::test
