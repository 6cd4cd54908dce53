// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace skinframe {
namespace {

// Cuts nearer to an end than this share of the edge pull that end onto the surface; table 1 of the paper.
constexpr double kPullLong = 0.24999, kPullShort = 0.41189;
constexpr int kBisections = 10;
constexpr double kLeastVolume = 1e-4;  // of a lattice tetrahedron's

constexpr int kPrismTurns[6][6] = {{0, 1, 2, 3, 4, 5}, {1, 2, 0, 4, 5, 3}, {2, 0, 1, 5, 3, 4},
                                   {3, 5, 4, 0, 2, 1}, {4, 3, 5, 1, 0, 2}, {5, 4, 3, 2, 1, 0}};

// Corners of the cubes first, their centres after.
class Lattice {
 public:
  Lattice(const BoundingBox& box, double spacing) : spacing_(spacing) {
    cells_ = (box.extent() / spacing).array().ceil().cast<int>() + 2;
    origin_ = 0.5 * (box.min + box.max) - 0.5 * spacing * cells_.cast<double>();
    corners_ = cells_.array() + 1;
    centre_base_ = corners_.x() * corners_.y() * corners_.z();
  }
  int corner(int x, int y, int z) const { return x + corners_.x() * (y + corners_.y() * z); }
  int centre(int x, int y, int z) const { return centre_base_ + x + cells_.x() * (y + cells_.y() * z); }
  bool is_centre(int i) const { return i >= centre_base_; }
  int size() const { return centre_base_ + cells_.x() * cells_.y() * cells_.z(); }
  Eigen::Vector3d point(int i) const {
    const Eigen::Vector3i n = is_centre(i) ? cells_ : corners_;
    const double shift = is_centre(i) ? 0.5 : 0.0;
    if (is_centre(i)) i -= centre_base_;
    const Eigen::Vector3d p(i % n.x(), (i / n.x()) % n.y(), i / (n.x() * n.y()));
    return origin_ + spacing_ * (p.array() + shift).matrix();
  }
  // visit(tet): two centres on either side of a face, and an edge of that face; positive volume.
  template <class Visit>
  void for_each_tet(Visit visit) const {
    for (int z = 0; z < cells_.z(); ++z)
      for (int y = 0; y < cells_.y(); ++y)
        for (int x = 0; x < cells_.x(); ++x)
          for (int axis = 0; axis < 3; ++axis) {
            const Eigen::Vector3i p(x, y, z), next = p + Eigen::Vector3i::Unit(axis);
            if (next[axis] == cells_[axis]) continue;
            const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3),
                                  v = Eigen::Vector3i::Unit((axis + 2) % 3);
            const Eigen::Vector3i ring[4] = {next, next + u, next + u + v, next + v};
            for (int k = 0; k < 4; ++k) {
              const Eigen::Vector3i &a = ring[k], &b = ring[(k + 1) % 4];
              visit(std::array<int, 4>{centre(x, y, z), corner(a.x(), a.y(), a.z()),
                                       corner(b.x(), b.y(), b.z()), centre(next.x(), next.y(), next.z())});
            }
          }
  }

 private:
  double spacing_;
  Eigen::Vector3d origin_;
  Eigen::Vector3i cells_, corners_;
  int centre_base_ = 0;
};

class Stuffing {
 public:
  Stuffing(const std::function<double(const Eigen::Vector3d&)>& level, const Lattice& lattice)
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
        const double limit = lattice_.is_centre(a) == lattice_.is_centre(b) ? kPullLong : kPullShort;
        too_near = too_near || distance < limit * (lattice_.point(a) - lattice_.point(b)).norm();
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
  const Lattice& lattice_;
  std::vector<double> value_;
  std::vector<int> place_;
  std::unordered_map<std::uint64_t, Cut> cuts_;
  std::vector<std::pair<int, int>> cut_edges_;
  std::unordered_map<int, Eigen::Vector3d> moved_;
  TetMesh mesh_;
};

}  // namespace

double least_spacing_mm(const BoundingBox& box) {
  // Two cells of margin on every axis.
  double spacing = std::cbrt(std::max(box.extent().prod(), 0.0) / kMaxLatticeCells);
  const auto cells = [&](double s) { return (box.extent().array() / s + 3.0).prod(); };
  spacing = std::max(spacing, 1e-6);
  while (cells(spacing) > kMaxLatticeCells) spacing *= 1.1;
  return spacing;
}

Result<TetMesh> fill_with_tetrahedra(const std::function<double(const Eigen::Vector3d&)>& level,
                                     const BoundingBox& box, double spacing_mm, const RunContext& context) {
  const double least = least_spacing_mm(box);
  if (!(spacing_mm >= least) || !std::isfinite(spacing_mm)) {
    return invalid_input(
        fmt::format("a lattice of {:.3g} mm has too many cells in the body's box: {:.3g} mm at least",
                    spacing_mm, least));
  }
  const Lattice lattice(box, spacing_mm);
  auto mesh = Stuffing(level, lattice).fill(context);
  if (!mesh) return mesh;
  const double least_volume = kLeastVolume * spacing_mm * spacing_mm * spacing_mm / kTetsACell;
  std::erase_if(mesh.value().tets,
                [&](const auto& tet) { return tet_volume_mm3(mesh.value(), tet) < least_volume; });
  return mesh;
}

}  // namespace skinframe
