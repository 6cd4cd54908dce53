// SPDX-License-Identifier: GPL-3.0-or-later
// The attitude in which a body needs the least support: the body's own first, and face down on each large
// face of its convex hull.
//
// All are ranked by one estimate of the added strut volume, on the surface alone, before there is a frame:
// each piece of flat skin needs a share of a strut, its area over the circle of radius p(theta) / 2 that one
// holds. Below an underside the strut is as long as the piece is high over the base plane, below a roof as
// long as the cavity is deep there; its radius is max(eta, length / alpha). Real supports branch and share,
// so the estimate ranks; it does not predict.
//
// An attitude counts only if the body stands in it (8), or if it stands in none.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/profile/printable_length.h"

namespace skinframe {

struct Attitude {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // of the body as given; proper
  double support_mm3 = 0;                                  // the estimate
  double margin_mm = 0;                                    // of its centroid inside its base contact
};

struct OrientOptions {
  double min_radius_mm = 0.4;
  std::optional<double> slenderness;
  double skin_thickness_mm = 0.8;
  int most_faces = 12;        // of the hull
  double least_share = 0.01;  // of the hull's area, for a face to be tried
};

// The best first; the body's own is among them, and is preferred where nothing needs less.
std::vector<Attitude> rank_attitudes(const TriangleMesh& closed_mesh, const PrintableLength& curve,
                                     const OrientOptions& options);

}  // namespace skinframe
