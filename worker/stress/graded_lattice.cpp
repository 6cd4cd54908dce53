// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/graded_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "worker/stress/lattice.h"

namespace skinframe {
namespace {

constexpr std::int64_t kUnits = std::int64_t{1} << (kMostHalvings + 1);  // in half a spacing

}  // namespace

GradedLattice::GradedLattice(const Lattice& lattice, const Function& level, const Function& finer_mm)
    : origin_(lattice.origin()), unit_mm_(0.5 * lattice.spacing_mm() / static_cast<double>(kUnits)) {
  for (int i = 0; i < lattice.size(); ++i) places_.push_back(kUnits * lattice.halves(i).cast<std::int64_t>());
  lattice.for_each_tet([&](const Tet& tet) {
    tets_.push_back(tet);
    list(static_cast<int>(tets_.size()) - 1);
  });
  const double least_mm = lattice.spacing_mm() / (1 << kMostHalvings) * (1 + 1e-9);
  const auto too_large = [&](int t) {
    const Tet& tet = tets_[t];
    const double longest_mm = unit_mm_ * std::sqrt(static_cast<double>(longest_edge(tet).length2));
    if (longest_mm <= least_mm) return false;
    const Eigen::Vector3d middle = 0.25 * (point(tet[0]) + point(tet[1]) + point(tet[2]) + point(tet[3]));
    return longest_mm > finer_mm(middle) && level(middle) <= longest_mm;
  };
  for (std::size_t t = 0; t < tets_.size(); ++t)  // those that are added are looked at in turn
    while (tets_.size() < kMostGradedTets && too_large(static_cast<int>(t)))
      bisect_towards(static_cast<int>(t));
  at_edge_.clear();
  measure_edges();
}

std::uint64_t GradedLattice::key(int a, int b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
}

GradedLattice::Edge GradedLattice::edge(int a, int b) const {
  return {(places_[a] - places_[b]).squaredNorm(), std::min(a, b), std::max(a, b)};
}

GradedLattice::Edge GradedLattice::longest_edge(const Tet& tet) const {
  Edge longest;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) longest = std::max(longest, edge(tet[i], tet[j]));
  return longest;
}

std::vector<int> GradedLattice::sharing(const Edge& edge) const {
  const auto has = [](const Tet& tet, int v) { return std::find(tet.begin(), tet.end(), v) != tet.end(); };
  std::vector<int> around;
  for (const int t : at_edge_.at(key(edge.a, edge.b)))
    if (has(tets_[t], edge.a) && has(tets_[t], edge.b)) around.push_back(t);
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  return around;
}

void GradedLattice::list(int tet) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) at_edge_[key(tets_[tet][i], tets_[tet][j])].push_back(tet);
}

// From neighbour to neighbour with a longer edge, until one is the longest of all that share it.
void GradedLattice::bisect_towards(int tet) {
  Edge longest = longest_edge(tets_[tet]);
  for (;;) {
    const std::vector<int> around = sharing(longest);
    Edge further = longest;
    for (const int t : around) further = std::max(further, longest_edge(tets_[t]));
    if (further == longest) return bisect(longest, around);
    longest = further;
  }
}

void GradedLattice::bisect(const Edge& edge, const std::vector<int>& around) {
  const int middle = static_cast<int>(places_.size());
  places_.push_back((places_[edge.a] + places_[edge.b]) / 2);
  for (const int t : around) {
    Tet other = tets_[t];
    std::replace(other.begin(), other.end(), edge.a, middle);
    std::replace(tets_[t].begin(), tets_[t].end(), edge.b, middle);
    tets_.push_back(other);
    list(t);
    list(static_cast<int>(tets_.size()) - 1);
  }
}

void GradedLattice::measure_edges() {
  shortest_mm_.assign(places_.size(), std::numeric_limits<double>::infinity());
  for (const Tet& tet : tets_)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) {
        const double length = unit_mm_ * std::sqrt(static_cast<double>(edge(tet[i], tet[j]).length2));
        for (const int v : {tet[i], tet[j]}) shortest_mm_[v] = std::min(shortest_mm_[v], length);
      }
}

}  // namespace skinframe
