// SPDX-License-Identifier: GPL-3.0-or-later
// The skin's own overhangs: roofs of the cavity, and undersides of M.
//
// Looked at from below in upright columns, `pitch` apart. A cell is the place where a column enters material
// from the cavity or from the air. It is held from beside where a neighbouring column is material lower down
// by at least the pitch over the tangent of the self-supporting angle: there the surface leans no flatter
// than that. The other cells are flat. From what is held (a cell beside, or a strut that comes up to it at a
// self-supporting angle) a flat skin reaches half of p(theta) of its own slope, along the surface and never
// downwards: as a bridge of length p has its middle p / 2 from either end.
#pragma once

#include <cstdint>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/support/plan_supports.h"

namespace skinframe {

struct FlatCell {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  // on the surface
  bool is_roof = true;                              // of the cavity; else an underside of M
  double area_mm2 = 0;                              // of the surface that it stands for
  double reach_mm = 0;                              // half of p(theta)
  double way_mm = 0;                                // from what holds it; infinite: nothing does
  bool beyond() const { return way_mm > reach_mm; }
};

struct Overhang {
  double roof_mm2 = 0, underside_mm2 = 0;                // of flat cells
  double roof_beyond_mm2 = 0, underside_beyond_mm2 = 0;  // of those that nothing reaches
};

// A strut's upper end, where it holds the skin.
struct Holder {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0;
  bool is_within = true;  // a strut within M holds roofs, one outside of it undersides
};

class FlatSkin {
 public:
  // box: of M. Cells are at most kMostColumns columns: a larger pitch is taken for larger bodies.
  FlatSkin(const PrintedBody& body, const BoundingBox& box, const PrintableLength& curve, double pitch_mm);
  static constexpr double kMostColumns = 250'000;

  void hold(const std::vector<Holder>& holders);
  // Points half way into the skin, above cells that nothing reaches, chosen until they would reach all of
  // them; the cell furthest from what holds it first. They count as holders from then on.
  std::vector<Eigen::Vector3d> points_to_hold(std::size_t most);
  Overhang measure() const;
  const std::vector<FlatCell>& cells() const { return cells_; }

 private:
  void spread(std::vector<int> changed);
  std::vector<int> neighbours(int cell) const;

  double pitch_mm_, into_skin_mm_;
  int columns_x_ = 0, columns_y_ = 0;
  std::vector<FlatCell> cells_;
  std::vector<int> first_of_column_;  // cells of column c: first[c] .. first[c + 1]
};

// Upper ends of struts and supports that come up at a self-supporting angle to a node in the skin.
std::vector<Holder> holders_of(const Frame& frame, const std::vector<double>& radii_mm,
                               const SupportPlan& plan, const PrintableLength& curve);

}  // namespace skinframe
