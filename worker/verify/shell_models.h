// SPDX-License-Identifier: GPL-3.0-or-later
// Structures of the valid model on one and the same fine skin: the skin-frame, the skin alone, and the body
// hollowed uniformly.
//
// Supports: the skin in the contact is held in x, y and z, that is all up to its highest contact node, and
// what lies within kContactToleranceMm of its lowest. (The paper's model holds single nodes, and as little as
// it can in the plane; here one point would carry a whole side load, and give way the more the finer the mesh
// is, so the contact counts as stuck to the plate.) Half the thickness below M lies the mid-surface; skin
// struts are the half discs below M1, internal struts count in full, in two parts, so that they can buckle by
// themselves.
#pragma once

#include <optional>
#include <vector>

#include "worker/mechanics/frame_problem.h"
#include "worker/structure/structure.h"
#include "worker/verify/fine_skin.h"

namespace skinframe {

// One nu for all polymers of the tables: their shear modulus would imply a negative one.
inline constexpr double kPoissonRatio = 0.35;

// Where the contact ends; none where the problem holds nothing of the skin.
std::optional<double> contact_height_mm(const FrameProblem& problem);

// radii_mm: one a strut of problem.frame; thinner ones than kVanishedRadiusMm are absent. Nodes: those of the
// fine skin, the frame's internal ones, the middles of internal struts.
Structure skin_frame_structure(const FrameProblem& problem, const std::vector<double>& radii_mm,
                               const Skin& skin, const FineSkin& fine);
Structure skin_alone_structure(const FrameProblem& problem, const Skin& skin, const FineSkin& fine);

// wall_mm: one a node of the fine skin.
Structure hollow_structure(const FrameProblem& problem, const Skin& skin, const FineSkin& fine,
                           const std::vector<double>& wall_mm);

// A load case of the fine skin as a column, weight included where gravity acts.
Eigen::VectorXd load_column(const Structure& structure, const LoadCase& load_case);

}  // namespace skinframe
