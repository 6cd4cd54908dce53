// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes spread evenly through the inside of M1: Lloyd's algorithm on the voxels that lie deeper than a
// margin.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

// Where internal nodes may stand: the points of a grid at least margin_mm below M1.
struct InnerRoom {
  std::vector<Eigen::Vector3d> samples;
  double spacing_mm = 0.0;
  double margin_mm = 0.0;
  double volume_mm3() const {
    return static_cast<double>(samples.size()) * spacing_mm * spacing_mm * spacing_mm;
  }
};
InnerRoom find_inner_room(const Skin& skin, double margin_mm);

// `count` nodes, fewer only when the room has fewer samples. Every node is at least margin_mm - spacing_mm /
// 2 below M1: a centroid that falls outside its own (concave) cell goes to the nearest sample. Seeded by the
// context; the same at any thread count.
std::vector<Eigen::Vector3d> spread_nodes(const InnerRoom& room, int count, const Skin& skin,
                                          const RunContext& context);

}  // namespace skinframe
