// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "worker/stress/graded_lattice.h"

namespace skinframe {
namespace {

constexpr int kBisections = 10;
constexpr double kLeastVolume = 1e-4;  // of a lattice tetrahedron's

constexpr int kPrismTurns[6][6] = {{0, 1, 2, 3, 4, 5}, {1, 2, 0, 4, 5, 3}, {2, 0, 1, 5, 3, 4},
                                   {3, 5, 4, 0, 2, 1}, {4, 3, 5, 1, 0, 2}, {5, 4, 3, 2, 1, 0}};

template <class Grid>
class Stuffing {
 public:
  Stuffing(const std::function<double(const Eigen::Vector3d&)>& level, const Grid& lattice)
      : level_(level), lattice_(lattice), value_(lattice.size()), place_(lattice.size(), -1) {}

  Result<TetMesh> fill(const RunContext& context) {
    for (int i = 0; i < lattice_.size(); ++i) value_[i] = level_(lattice_.point(i));
    if (context.cancelled()) return cancelled_error();
    find_cuts();
    if (context.cancelled()) return cancelled_error();
    pull_near_points();
    lattice_.for_each_tet([&](const std::array<int, 4>& tet) { keep_inside(tet); });
    return std::move(mesh_);
  }

 private:
  struct Cut {
    Eigen::Vector3d point;
    int vertex = -1;
  };
  static std::uint64_t key(int a, int b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
  }

  void find_cuts() {
    lattice_.for_each_tet([&](const std::array<int, 4>& tet) {
      for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
          const int a = std::min(tet[i], tet[j]), b = std::max(tet[i], tet[j]);
          if ((value_[a] < 0.0) == (value_[b] < 0.0) || value_[a] == 0.0 || value_[b] == 0.0) continue;
          const auto [it, fresh] = cuts_.try_emplace(key(a, b));
          if (!fresh) continue;
          it->second.point = zero_between(a, b);
          cut_edges_.emplace_back(a, b);
        }
    });
  }

  Eigen::Vector3d zero_between(int a, int b) const {
    Eigen::Vector3d inside = lattice_.point(value_[a] < 0.0 ? a : b);
    Eigen::Vector3d outside = lattice_.point(value_[a] < 0.0 ? b : a);
    for (int i = 0; i < kBisections; ++i) {
      const Eigen::Vector3d middle = 0.5 * (inside + outside);
      (level_(middle) < 0.0 ? inside : outside) = middle;
    }
    return 0.5 * (inside + outside);
  }

  // Each lattice point with a cut too near goes to the nearest of its cuts, lowest index first: once a point
  // stands on the surface, its edges are cut no more.
  void pull_near_points() {
    std::vector<std::pair<int, std::size_t>> ends;  // point, cut edge
    for (std::size_t e = 0; e < cut_edges_.size(); ++e) {
      ends.emplace_back(cut_edges_[e].first, e);
      ends.emplace_back(cut_edges_[e].second, e);
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i < ends.size();) {
      const int point = ends[i].first;
      const Eigen::Vector3d from = lattice_.point(point);
      double nearest = std::numeric_limits<double>::infinity();
      Eigen::Vector3d to = from;
      bool too_near = false;
      for (; i < ends.size() && ends[i].first == point; ++i) {
        const auto& [a, b] = cut_edges_[ends[i].second];
        if (value_[a] == 0.0 || value_[b] == 0.0) continue;  // the other end was pulled before
        const Eigen::Vector3d& cut = cuts_.at(key(a, b)).point;
        const double distance = (cut - from).norm();
        too_near = too_near || distance < lattice_.pull_mm(point, a, b);
        if (distance >= nearest) continue;
        nearest = distance;
        to = cut;
      }
      if (!too_near) continue;
      value_[point] = 0.0;
      moved_.emplace(point, to);
    }
  }

  int vertex(int lattice_point) {
    int& place = place_[lattice_point];
    if (place < 0) {
      place = static_cast<int>(mesh_.vertices_mm.size());
      const auto moved = moved_.find(lattice_point);
      mesh_.vertices_mm.push_back(moved == moved_.end() ? lattice_.point(lattice_point) : moved->second);
    }
    return place;
  }
  int cut_vertex(int a, int b) {
    Cut& cut = cuts_.at(key(a, b));
    if (cut.vertex < 0) {
      cut.vertex = static_cast<int>(mesh_.vertices_mm.size());
      mesh_.vertices_mm.push_back(cut.point);
    }
    return cut.vertex;
  }

  void keep_inside(const std::array<int, 4>& tet) {
    std::vector<int> in, on, out;
    for (const int i : tet) (value_[i] < 0.0 ? in : value_[i] > 0.0 ? out : on).push_back(i);
    if (in.empty()) return;
    if (out.empty()) {
      add({vertex(tet[0]), vertex(tet[1]), vertex(tet[2]), vertex(tet[3])});
    } else if (in.size() == 1) {
      std::array<int, 4> rest{vertex(in[0]), 0, 0, 0};
      int k = 1;
      for (const int i : on) rest[k++] = vertex(i);
      for (const int i : out) rest[k++] = cut_vertex(in[0], i);
      add(rest);
    } else if (in.size() == 2 && out.size() == 1) {
      add_pyramid({vertex(in[0]), vertex(in[1]), cut_vertex(in[1], out[0]), cut_vertex(in[0], out[0])},
                  vertex(on[0]));
    } else if (in.size() == 2) {
      add_prism({vertex(in[0]), cut_vertex(in[0], out[0]), cut_vertex(in[0], out[1]), vertex(in[1]),
                 cut_vertex(in[1], out[0]), cut_vertex(in[1], out[1])});
    } else {
      add_prism({vertex(in[0]), vertex(in[1]), vertex(in[2]), cut_vertex(in[0], out[0]),
                 cut_vertex(in[1], out[0]), cut_vertex(in[2], out[0])});
    }
  }

  void add_pyramid(const std::array<int, 4>& base, int apex) {
    const auto least = std::min_element(base.begin(), base.end()) - base.begin();
    const int a = base[least], b = base[(least + 1) % 4], c = base[(least + 2) % 4],
              d = base[(least + 3) % 4];
    add({a, b, c, apex});
    add({a, c, d, apex});
  }
  // Every quadrilateral is cut at its least vertex (Dompierre et al., "How to subdivide pyramids, prisms and
  // hexahedra into tetrahedra", 1999): always possible, and the neighbour cuts it alike.
  void add_prism(const std::array<int, 6>& prism) {
    const int* turn = kPrismTurns[std::min_element(prism.begin(), prism.end()) - prism.begin()];
    std::array<int, 6> v;
    for (int k = 0; k < 6; ++k) v[k] = prism[turn[k]];
    if (std::min(v[1], v[5]) < std::min(v[2], v[4])) {
      add({v[0], v[1], v[2], v[5]});
      add({v[0], v[1], v[5], v[4]});
    } else {
      add({v[0], v[1], v[2], v[4]});
      add({v[0], v[4], v[2], v[5]});
    }
    add({v[0], v[4], v[5], v[3]});
  }
  void add(std::array<int, 4> tet) {
    if (tet_volume_mm3(mesh_, tet) < 0.0) std::swap(tet[2], tet[3]);
    mesh_.tets.push_back(tet);
  }

  const std::function<double(const Eigen::Vector3d&)>& level_;
  const Grid& lattice_;
  std::vector<double> value_;
  std::vector<int> place_;
  std::unordered_map<std::uint64_t, Cut> cuts_;
  std::vector<std::pair<int, int>> cut_edges_;
  std::unordered_map<int, Eigen::Vector3d> moved_;
  TetMesh mesh_;
};

double lattice_cells(const BoundingBox& box, double spacing_mm) {
  return (box.extent().array() / spacing_mm + 3.0).prod();  // two cells of margin on every axis
}

Status check_spacing(const BoundingBox& box, double spacing_mm, double most_cells) {
  const double least = least_spacing_mm(box, most_cells);
  if (spacing_mm >= least && std::isfinite(spacing_mm)) return ok_status();
  return invalid_input(fmt::format(
      "a lattice of {:.3g} mm has too many cells in the body's box: {:.3g} mm at least", spacing_mm, least));
}

template <class LeastVolume>
Result<TetMesh> without_slivers(Result<TetMesh> mesh, LeastVolume least_mm3) {
  if (mesh)
    std::erase_if(mesh.value().tets, [&](const auto& tet) {
      return tet_volume_mm3(mesh.value(), tet) < least_mm3(mesh.value(), tet);
    });
  return mesh;
}

}  // namespace

double least_spacing_mm(const BoundingBox& box, double most_cells) {
  double spacing = std::cbrt(std::max(box.extent().prod(), 0.0) / most_cells);
  spacing = std::max(spacing, 1e-6);
  while (lattice_cells(box, spacing) > most_cells) spacing *= 1.1;
  return spacing;
}

Result<TetMesh> fill_with_tetrahedra(const std::function<double(const Eigen::Vector3d&)>& level,
                                     const BoundingBox& box, double spacing_mm, const RunContext& context) {
  const Status checked = check_spacing(box, spacing_mm, kMaxLatticeCells);
  if (!checked) return checked.error();
  const Lattice lattice(box, spacing_mm);
  const double least_volume = kLeastVolume * spacing_mm * spacing_mm * spacing_mm / kTetsACell;
  return without_slivers(Stuffing(level, lattice).fill(context),
                         [&](const TetMesh&, const std::array<int, 4>&) { return least_volume; });
}

Result<TetMesh> fill_with_graded_tetrahedra(const std::function<double(const Eigen::Vector3d&)>& level,
                                            const BoundingBox& box, double spacing_mm,
                                            const SpacingAt& finer_mm, const RunContext& context) {
  const Status checked = check_spacing(box, spacing_mm, kMostGradedCells);
  if (!checked) return checked.error();
  const GradedLattice lattice(Lattice(box, spacing_mm), level, finer_mm);
  if (context.cancelled()) return cancelled_error();
  return without_slivers(Stuffing(level, lattice).fill(context), [](const TetMesh& mesh,
                                                                    const std::array<int, 4>& tet) {
    double longest2 = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        longest2 = std::max(longest2, (mesh.vertices_mm[tet[i]] - mesh.vertices_mm[tet[j]]).squaredNorm());
    return kLeastVolume * longest2 * std::sqrt(longest2) / kTetsACell;
  });
}

}  // namespace skinframe
