// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of one block under names of their own, for edge collapses: what is about a vertex, what
// became of a triangle, which points of the surface as it was belong to it. Lengths in mm.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "worker/export/thin_block.h"
#include "worker/export/triangle_gap.h"

namespace skinframe {

inline Eigen::Vector3d normal_of(const Corners& p) { return (p[1] - p[0]).cross(p[2] - p[0]); }  // not unit

inline Eigen::AlignedBox3d box_of(const Corners& p) {
  Eigen::AlignedBox3d box(p[0]);
  box.extend(p[1]);
  box.extend(p[2]);
  return box;
}

// A triangle as a collapse would leave it.
struct ChangedTriangle {
  int triangle;
  Corners corners;
  Eigen::AlignedBox3d box;
  Eigen::Vector3d normal;  // not of unit length
};

class BlockMesh {
 public:
  BlockMesh(ThinningState& state, const ThinningBlock& block);
  void write_back() const;

  int own() const { return own_; }  // the first so many triangles are the block's own, the others stay
  std::size_t triangles() const { return triangles_.size(); }
  std::size_t vertices() const { return numbers_.size(); }
  const std::array<int, 3>& triangle(int t) const { return triangles_[t]; }
  const Eigen::Vector3d& place(int v) const { return places_[v]; }
  bool is_exact(int v) const { return numbers_[v] < state_.exact_vertices; }
  bool is_locked(int v) const { return locked_[v] != 0; }
  bool is_dead(int v) const { return dead_[v] != 0; }
  bool is_alive(int t) const { return slots_[t].alive; }
  bool has(int t, int v) const {
    const auto& c = triangles_[t];
    return c[0] == v || c[1] == v || c[2] == v;
  }
  Corners corners_of(int t) const {
    const Eigen::Matrix3f& shape = slots_[t].shape;
    return {shape.col(0).cast<double>(), shape.col(1).cast<double>(), shape.col(2).cast<double>()};
  }

  // True the first time that it is asked of a triangle since begin_search().
  void begin_search() { ++stamp_; }
  bool see(int t) {
    const bool first = slots_[t].seen != stamp_;
    slots_[t].seen = stamp_;
    return first;
  }

  // The triangles about v, in a steady order; forgets those that are gone.
  void gather(int v, std::vector<int>& around);
  // The vertices about v, in a steady order.
  void neighbours(int v, const std::vector<int>& around, std::vector<int>& near);
  // Whether neighbours() has named it last.
  bool was_neighbour(int v) const { return seen_[v] == vertex_stamp_; }

  // visit(number, point) of each point of the surface that belongs to t.
  template <class Visit>
  void for_each_point(int t, Visit visit) const {
    for (int p = first_point_[t]; p >= 0; p = next_point_[p]) visit(p, state_.points[points_[p]]);
  }

  // v becomes u, at `place`: `star` are the triangles about both, of which `changed` remain, and `moved` says
  // which triangle each of their points belongs to from now on.
  void merge(int u, int v, const Eigen::Vector3d& place, const std::vector<int>& star,
             const std::vector<ChangedTriangle>& changed, const std::vector<std::pair<int, int>>& moved);

 private:
  // All that a search meets of a triangle, in one line of the cache.
  struct alignas(64) Slot {
    Eigen::Matrix3f shape;  // its corners: all are exact floats
    std::uint32_t seen = 0;
    bool alive = true;
  };

  void number_vertices();
  void link_triangles();
  void keep_shape_of(int t, const Corners& p) {
    for (int k = 0; k < 3; ++k) slots_[t].shape.col(k) = p[k].cast<float>();
  }

  ThinningState& state_;
  const ThinningBlock& block_;
  int own_ = 0;
  std::vector<int> numbers_;  // in the mesh, of each vertex
  std::vector<Eigen::Vector3d> places_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<char> dead_, locked_;
  std::vector<std::uint32_t> seen_;  // one a vertex: in which search for neighbours
  std::vector<Slot> slots_;          // one a triangle
  std::vector<int> first_corner_, next_corner_;
  std::vector<int> points_, first_point_, next_point_;
  std::uint32_t stamp_ = 0, vertex_stamp_ = 0;
};

}  // namespace skinframe
