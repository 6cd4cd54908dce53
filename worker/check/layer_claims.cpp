// SPDX-License-Identifier: GPL-3.0-or-later
// The layers of what is printed, from the exported meshes alone: skin-frame.stl and the external supports,
// sliced and filled by winding number on a lattice.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

using Eigen::Vector3d;

constexpr double kPitchInRadii = 1.0;  // of the lattice and the layers, in the least radius
constexpr double kMostCells = 4e6;     // of a layer: a coarser lattice is taken for larger bodies
constexpr double kMostCellsInAll = 3e8;
constexpr double kMostLayers = 4000;  // and cells a side
constexpr double kLeastPitchMm = 1e-3;
constexpr double kFlattestDegrees = 80;     // more is taken for this
constexpr double kDiagonal = 1.5;           // cells; from a cell to the next ones, and some room
constexpr double kLeastSpotInStruts = 2.0;  // smaller: patches that a level strut's underside comes up in
constexpr double kLeastFilled = 0.7;        // of the volume: layers that are empty prove nothing

class Lattice {
 public:
  Lattice(const BoundingBox& box, double pitch_mm)
      : origin_(box.min),
        pitch_mm_(pitch_mm),
        nx_(static_cast<int>(box.extent().x() / pitch_mm) + 2),
        ny_(static_cast<int>(box.extent().y() / pitch_mm) + 2) {}

  int columns() const { return nx_; }
  int rows() const { return ny_; }
  double pitch_mm() const { return pitch_mm_; }
  Vector3d middle(int cell, double z) const {
    return {origin_.x() + (cell % nx_ + 0.5) * pitch_mm_, origin_.y() + (cell / nx_ + 0.5) * pitch_mm_, z};
  }
  // The first column, or row, whose middle is at or beyond the place.
  int column_from(double x) const { return first(x - origin_.x(), nx_); }
  int row_from(double y) const { return first(y - origin_.y(), ny_); }
  double row_y(int row) const { return origin_.y() + (row + 0.5) * pitch_mm_; }

 private:
  int first(double at, int count) const {
    return std::clamp(static_cast<int>(std::ceil(at / pitch_mm_ - 0.5)), 0, count);
  }
  Vector3d origin_;
  double pitch_mm_;
  int nx_, ny_;
};

using Cells = std::vector<char>;

// Layers of a closed surface, from below upwards.
class Slices {
 public:
  Slices(const TriangleMesh& mesh, const Lattice& lattice, double first_z, double height_mm)
      : mesh_(mesh), lattice_(lattice) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [low, high] = heights(static_cast<int>(t));
      const double layer = std::ceil((low - first_z) / height_mm);
      if (first_z + std::max(layer, 0.0) * height_mm > high) continue;  // between two layers
      const auto at = static_cast<std::size_t>(std::max(layer, 0.0));
      if (at >= starts_.size()) starts_.resize(at + 1);
      starts_[at].push_back(static_cast<int>(t));
    }
  }

  void fill(std::size_t layer, double z, Cells& cells) {
    if (layer < starts_.size()) active_.insert(active_.end(), starts_[layer].begin(), starts_[layer].end());
    std::erase_if(active_, [&](int t) { return heights(t).second < z; });
    crossings_.resize(static_cast<std::size_t>(lattice_.rows()));
    for (auto& row : crossings_) row.clear();
    for (const int t : active_) cut(t, z);
    for (int row = 0; row < lattice_.rows(); ++row) {
      auto& list = crossings_[static_cast<std::size_t>(row)];
      std::sort(list.begin(), list.end());
      int winding = 0;
      for (std::size_t k = 0; k + 1 < list.size(); ++k) {
        winding += list[k].second;
        if (winding <= 0) continue;
        const int to = lattice_.column_from(list[k + 1].first);
        for (int x = lattice_.column_from(list[k].first); x < to; ++x)
          cells[static_cast<std::size_t>(row) * lattice_.columns() + x] = 1;
      }
    }
  }

 private:
  std::pair<double, double> heights(int t) const {
    const auto& c = mesh_.triangles[static_cast<std::size_t>(t)];
    const double a = mesh_.vertices[c[0]].z(), b = mesh_.vertices[c[1]].z(), d = mesh_.vertices[c[2]].z();
    return {std::min({a, b, d}), std::max({a, b, d})};
  }
  // Where the triangle's cut with the layer meets the rows: a vertex at the height counts as above it, as one
  // at a row's y does beyond it, so that neighbours agree.
  void cut(int t, double z) {
    const auto& c = mesh_.triangles[static_cast<std::size_t>(t)];
    Vector3d up, down;  // where the boundary of the triangle, gone round, rises and falls through z
    int found = 0;
    for (int k = 0; k < 3; ++k) {
      int from = c[k], to = c[(k + 1) % 3];
      const bool above = mesh_.vertices[from].z() >= z;
      if (above == (mesh_.vertices[to].z() >= z)) continue;
      if (above) std::swap(from, to);  // the same point for both triangles of an edge
      const Vector3d &a = mesh_.vertices[from], &b = mesh_.vertices[to];
      (above ? down : up) = a + (z - a.z()) / (b.z() - a.z()) * (b - a);
      ++found;
    }
    if (found != 2) return;
    // Material lies to the right of up -> down, seen from above: a crossing towards +y enters it.
    const bool falls = down.y() < up.y();
    const Vector3d &low = falls ? down : up, &high = falls ? up : down;
    const int to = lattice_.row_from(high.y());
    for (int row = lattice_.row_from(low.y()); row < to; ++row) {
      const double s = (lattice_.row_y(row) - low.y()) / (high.y() - low.y());
      crossings_[static_cast<std::size_t>(row)].emplace_back(low.x() + s * (high.x() - low.x()),
                                                             falls ? -1 : 1);
    }
  }

  const TriangleMesh& mesh_;
  const Lattice& lattice_;
  std::vector<std::vector<int>> starts_;  // triangles by the first layer that they reach
  std::vector<int> active_;
  std::vector<std::vector<std::pair<double, int>>> crossings_;  // of each row: x, and +1 into material
};

template <class Ask>
bool any_around(const Lattice& lattice, int cell, int cells, Ask ask) {
  const int x = cell % lattice.columns(), y = cell / lattice.columns();
  for (int ny = std::max(0, y - cells); ny <= std::min(lattice.rows() - 1, y + cells); ++ny)
    for (int nx = std::max(0, x - cells); nx <= std::min(lattice.columns() - 1, x + cells); ++nx)
      if (ask(ny * lattice.columns() + nx, std::hypot(nx - x, ny - y))) return true;
  return false;
}

std::vector<std::vector<int>> parts_of(const Lattice& lattice, const Cells& layer) {
  Cells seen(layer.size(), 0);
  std::vector<std::vector<int>> parts;
  for (int start = 0; start < static_cast<int>(layer.size()); ++start) {
    if (!layer[start] || seen[start]) continue;
    std::vector<int> part{start};
    seen[start] = 1;
    for (std::size_t k = 0; k < part.size(); ++k)
      any_around(lattice, part[k], 1, [&](int other, double) {
        if (layer[other] && !seen[other]) {
          seen[other] = 1;
          part.push_back(other);
        }
        return false;
      });
    parts.push_back(std::move(part));
  }
  return parts;
}

// Somewhere two cells wide, the thinnest strut's diameter. What is narrower everywhere, as where the
// underside of a level strut comes up between two layers, is no line that a slicer draws; nor does it hold
// what is above.
bool is_drawn(const Lattice& lattice, const Cells& layer, const std::vector<int>& part) {
  const int next_row = lattice.columns();  // no part reaches the last column or row
  return std::any_of(part.begin(), part.end(), [&](int cell) {
    return layer[cell + 1] && layer[cell + next_row] && layer[cell + next_row + 1];
  });
}

}  // namespace

void claim_layers(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedSupports& supports = *result.supports;
  BoundingBox box = bounding_box(*result.merged);
  for (const Vector3d& v : supports.external_mesh.vertices) {
    box.min = box.min.cwiseMin(v);
    box.max = box.max.cwiseMax(v);
  }
  const Vector3d extent = box.extent();
  const double pitch =
      std::max({kPitchInRadii * result.eta_mm, std::sqrt(extent.x() * extent.y() / kMostCells),
                std::cbrt(extent.prod() / kMostCellsInAll), extent.maxCoeff() / kMostLayers, kLeastPitchMm});
  const Lattice lattice(box, pitch);
  const double first = std::max(supports.plate_z_mm, box.min.z()) + 0.5 * pitch;
  Slices body(*result.merged, lattice, first, pitch), outside(supports.external_mesh, lattice, first, pitch);
  const double angle =
      std::clamp(supports.self_supporting_angle_deg, 0.0, kFlattestDegrees) * std::numbers::pi / 180;
  const double reach =
      std::max(std::tan(angle), kDiagonal);  // in cells: a layer is as high as a cell is wide
  const int around = static_cast<int>(std::ceil(reach));
  const double least_mm2 = kLeastSpotInStruts * std::numbers::pi * result.eta_mm * result.eta_mm;

  const std::size_t size = static_cast<std::size_t>(lattice.columns()) * lattice.rows();
  Cells below(size, 0), layer(size, 0);
  int layers = 0, islands = 0;
  double area = 0, largest = 0, filled_mm3 = 0;
  Vector3d at = Vector3d::Zero();
  for (double z = first; z < box.max.z(); z = first + ++layers * pitch) {
    std::fill(layer.begin(), layer.end(), 0);
    body.fill(static_cast<std::size_t>(layers), z, layer);
    filled_mm3 += static_cast<double>(std::count(layer.begin(), layer.end(), 1)) * pitch * pitch * pitch;
    outside.fill(static_cast<std::size_t>(layers), z, layer);
    if (z > supports.plate_z_mm + supports.plate_reach_mm)
      for (const std::vector<int>& part : parts_of(lattice, layer)) {
        const double part_mm2 = static_cast<double>(part.size()) * pitch * pitch;
        if (part_mm2 <= least_mm2) continue;
        if (std::any_of(part.begin(), part.end(), [&](int cell) {
              return any_around(lattice, cell, around, [&](int other, double distance) {
                return below[other] != 0 && distance <= reach + 1e-9;
              });
            }))
          continue;
        if (!is_drawn(lattice, layer, part)) {
          for (const int cell : part) layer[cell] = 0;
          continue;
        }
        ++islands;
        area += part_mm2;
        if (part_mm2 > largest) {
          largest = part_mm2;
          at = lattice.middle(part.front(), z);
        }
      }
    std::swap(below, layer);
  }
  const double volume = signed_volume(*result.merged);
  verdict->claims.push_back(
      {"no layer starts in the air", islands == 0 && filled_mm3 > kLeastFilled * volume,
       fmt::format(
           "{} parts of {} layers of {:.2g} mm touch nothing below within {:g} degrees{}; the layers hold "
           "{:.0f} mm3, the mesh {:.0f} mm3",
           islands, layers, pitch, supports.self_supporting_angle_deg,
           islands == 0 ? std::string()
                        : fmt::format(", {:.1f} mm2 in all, the largest at ({:.1f}, {:.1f}, {:.1f})", area,
                                      at.x(), at.y(), at.z()),
           filled_mm3, volume)});
}

}  // namespace skinframe::check
