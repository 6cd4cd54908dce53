// SPDX-License-Identifier: GPL-3.0-or-later
// Whether an edge of a block may become one vertex: the surface stays a surface, no triangle turns far or
// becomes a sliver, none strays from the surface as it was, none meets another one. Lengths in mm.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "worker/export/block_grid.h"
#include "worker/export/block_mesh.h"

namespace skinframe {

class CollapseTrial {
 public:
  // is_exact: the surface as it was is asked wherever no point of it is near enough; else its points about
  // are believed, and stays_on_surface() tells whether that went well.
  CollapseTrial(const ThinningState& state, const ThinningBlock& block, const BlockLimits& limits,
                bool is_exact, BlockMesh& mesh);

  // The edge from u to v may go to `place`.
  bool holds(int u, int v, const Eigen::Vector3d& place);
  // Does what held last.
  void carry_out(int u, int v, const Eigen::Vector3d& place);
  // Whether the corners and the middles of all triangles that changed are near enough to the surface as it
  // was, where that is known.
  bool stays_on_surface() const;

 private:
  void fill_grid(const Eigen::AlignedBox3d& box);
  bool keeps_manifold(int u, int v);
  bool keeps_shape() const;
  bool keeps_points(int u, const Eigen::Vector3d& place);
  bool is_on_surface(const Eigen::Vector3d& place) const;
  bool keeps_clear(int u, int v);
  bool clear(const ChangedTriangle& changed, int t, const Corners& q, int u, int v);
  bool is_beyond(const ChangedTriangle& changed, const Corners& q, int i, int j);
  // Of each side, in the plane, of unit length.
  using Outward = std::array<Eigen::Vector3d, 3>;
  const Outward& outward_of(const ChangedTriangle& changed);

  const ThinningState& state_;
  const BlockLimits& limits_;
  const bool is_exact_;
  BlockMesh& mesh_;
  std::optional<BlockGrid> grid_;
  std::vector<char> changed_, moved_;  // one a triangle; one a vertex
  // Of the collapse being tried.
  std::vector<int> around_u_, around_v_, near_u_, near_v_, star_;
  std::vector<ChangedTriangle> new_;
  std::vector<std::optional<Outward>> outward_;  // of each, once it is asked for
  std::vector<Eigen::Vector3d> star_places_, star_normals_;
  std::vector<std::pair<int, int>> moved_points_;
};

}  // namespace skinframe
