// SPDX-License-Identifier: GPL-3.0-or-later
// The print layer by layer, on a lattice: skin, struts and supports as material. An island is a connected
// part of a layer that nothing in the layer below holds: it would start in the air.
//
// A cell holds those of the next layer within the layer's height times the tangent of the self-supporting
// angle, and within a cell's diagonal. What reaches further from a held cell within its own layer is an
// overhang, not an island: overhang.h measures those of the skin.
#pragma once

#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/support/plan_supports.h"

namespace skinframe {

struct Island {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  // the middle of its most central cell
  double area_mm2 = 0;
};

struct Layers {
  int count = 0;
  std::vector<Island> islands;  // from below upwards
};

struct LayerOptions {
  double pitch_mm = 0.5;  // below 1.1 of the thinnest strut's radius no strut falls between the cells
  double height_mm = 0.4;
};

Layers find_islands(const PrintedBody& body, const BoundingBox& box, const Frame& frame,
                    const std::vector<double>& radii_mm, const SupportPlan& plan,
                    const PrintableLength& curve, const LayerOptions& options);

}  // namespace skinframe
