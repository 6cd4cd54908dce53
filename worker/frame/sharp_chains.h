// SPDX-License-Identifier: GPL-3.0-or-later
// Sharp edges of M1 as chains of edges of a piece's triangulation, kept through collapse and relaxation:
// their corners stay where they are, their other nodes slide along, and consecutive nodes stay joined by a
// strut.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/skin/sharp_edges.h"

namespace skinframe {

class SharpChains {
 public:
  // For each curve near the piece, a path of its edges from end to end; the path's vertices are moved onto
  // the curve. A loop gets three fixed vertices. A curve without such a path, because it stands too near to
  // another, is left out. reach: how far from the curve the piece's surface may stand, which is a level set's
  // with bevels.
  SharpChains() = default;
  SharpChains(TriangleMesh& piece, const std::vector<SharpCurve>& curves, double reach_mm);

  bool empty() const { return chains_.empty(); }
  // Vertices are named by their number in the piece, whatever became of the others. -1 names none.
  bool is_on(int vertex) const { return vertex >= 0 && role(vertex) != Role::kNone; }
  bool is_corner(int vertex) const { return vertex >= 0 && role(vertex) == Role::kCorner; }
  Eigen::Vector3d corner_mm(int corner) const { return corners_mm_.at(corner); }
  // Whether they follow each other on a chain; the two ends of a chain do where nothing is left between them
  // and the curve is one with corners of its own (SharpCurve::corners).
  bool are_joined(int u, int v) const { return is_beside(u, v) || is_beside(v, u) || are_ends(u, v); }
  // The vertex is no more; those beside it follow each other now. Not for corners.
  void drop(int vertex);
  // Half way between those beside the vertex, along the curve.
  Eigen::Vector3d slide(int vertex);
  std::vector<Eigen::Vector3d> points_mm() const;  // of all curves

 private:
  enum class Role : char { kNone, kInner, kCorner };
  struct Chain {
    std::vector<Eigen::Vector3d> points_mm;
    std::vector<double> along_mm;  // of each point
    int inner = 0;                 // vertices between its ends
    double length() const { return along_mm.back(); }
    Eigen::Vector3d at(double along) const;
    double nearest(const Eigen::Vector3d& p) const;  // where along it
  };
  struct Link {  // of an inner vertex
    int chain = -1, before = -1, after = -1;
    double along_mm = 0.0;
  };
  Role role(int vertex) const { return roles_[vertex]; }
  bool is_beside(int u, int v) const {
    return u >= 0 && v >= 0 && role(u) == Role::kInner && (links_[u].before == v || links_[u].after == v);
  }
  bool are_ends(int u, int v) const {
    if (!is_corner(u) || !is_corner(v)) return false;
    const auto at = chain_between_.find(std::minmax(u, v));
    return at != chain_between_.end() && chains_[at->second].inner == 0;
  }
  static Chain chain_of(const std::vector<Eigen::Vector3d>& points);
  void add(TriangleMesh& piece, const Chain& chain, const std::vector<int>& path, bool keeps_its_ends);
  friend class ChainFinder;

  std::vector<Role> roles_;
  std::vector<Link> links_;
  std::vector<Chain> chains_;
  std::map<int, Eigen::Vector3d> corners_mm_;
  std::map<std::pair<int, int>, int> chain_between_;  // by ends, of curves with corners of their own
};

}  // namespace skinframe
