// SPDX-License-Identifier: GPL-3.0-or-later
// Points and chords against M1, by the distance field. Lengths in mm.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "worker/skin/build_skin.h"

namespace skinframe {

// Furthest that the segment a-b stands outside of M1 (towards M) and below it, mm, each >= 0.
struct ChordDeviation {
  double outward_mm = 0.0;
  double inward_mm = 0.0;
};
ChordDeviation chord_deviation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Skin& skin);

// A point of M1 near to p, by Newton steps in the distance field; p itself on the medial axis.
Eigen::Vector3d onto_m1(const Eigen::Vector3d& p, const Skin& skin);

// The first crossing of M1 on the line through `from` along the unit normal, to the side where M1 is.
std::optional<Eigen::Vector3d> first_on_m1(const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
                                           double reach_mm, const Skin& skin);

}  // namespace skinframe
