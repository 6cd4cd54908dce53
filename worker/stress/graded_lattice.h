// SPDX-License-Identifier: GPL-3.0-or-later
// The body-centred cubic lattice, finer where it is asked to be: its tetrahedra bisected at their longest
// edges, neighbours first where they have a longer one (Rivara, "Algorithms for refining triangular grids",
// Int. J. Numer. Meth. Engng 20, 1984). Bisected three times, a tetrahedron of this lattice is eight of half
// its size and its own shape; the two shapes between are hardly worse (Maubach, SIAM J. Sci. Comput. 16,
// 1995). Coordinates are whole numbers, so that lengths compare exactly.
//
// Guarantees: neighbours share whole faces; no tetrahedron whose longest edge is longer than asked for at its
// middle, unless it has been halved kMostHalvings times, lies outside by more than that edge, or there are
// kMostGradedTets.
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "worker/stress/cubic_lattice.h"

namespace skinframe {

inline constexpr int kMostHalvings = 6;

class GradedLattice {
 public:
  using Function = std::function<double(const Eigen::Vector3d&)>;
  GradedLattice(const Lattice& lattice, const Function& level, const Function& finer_mm);

  int size() const { return static_cast<int>(places_.size()); }
  Eigen::Vector3d point(int i) const { return origin_ + unit_mm_ * places_[i].cast<double>(); }
  double pull_mm(int point, int /*a*/, int /*b*/) const { return kPull * shortest_mm_[point]; }
  template <class Visit>
  void for_each_tet(Visit visit) const {
    for (const Tet& tet : tets_) visit(tet);
  }

 private:
  using Tet = std::array<int, 4>;
  using Place = Eigen::Matrix<std::int64_t, 3, 1>;
  struct Edge {
    std::int64_t length2 = 0;
    int a = 0, b = 0;                               // a < b
    auto operator<=>(const Edge&) const = default;  // the total order of lengths
  };
  static constexpr double kPull = 0.3;  // of the shortest edge

  static std::uint64_t key(int a, int b);
  Edge edge(int a, int b) const;
  Edge longest_edge(const Tet& tet) const;
  std::vector<int> sharing(const Edge& edge) const;
  void list(int tet);
  void bisect_towards(int tet);
  void bisect(const Edge& edge, const std::vector<int>& around);
  void measure_edges();

  Eigen::Vector3d origin_;
  double unit_mm_;
  std::vector<Place> places_;
  std::vector<Tet> tets_;
  std::unordered_map<std::uint64_t, std::vector<int>> at_edge_;  // numbers of tetrahedra, also of former ones
  std::vector<double> shortest_mm_;                              // edge at each point
};

}  // namespace skinframe
