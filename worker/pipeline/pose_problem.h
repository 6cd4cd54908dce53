// SPDX-License-Identifier: GPL-3.0-or-later
// From a sampled frame to the problem that the optimiser is asked: supports, loads, weights, bounds, balance.
#pragma once

#include "worker/frame/sample_frame.h"
#include "worker/mechanics/frame_problem.h"
#include "worker/pipeline/request.h"
#include "worker/skin/build_skin.h"
#include "worker/solid/contact.h"
#include "worker/solid/solid.h"

namespace skinframe {

// How the plate holds the contact nodes. In z all of them are held, both ways: the object counts as clamped
// to the plate, and where that pulls, the report lists it under "tips".
enum class Supports {
  kLeast,   // in the plane: one node in x and y and one axis of the furthest other node, the least that stops
            // it
  kPinned,  // in the plane: all of them
};

// Held axes, one entry a node. contact_nodes: at least three, not in line.
std::vector<std::array<bool, 3>> hold_contact(const Frame& frame, const std::vector<int>& contact_nodes,
                                              Supports supports);

// What became of the wish for balance (8).
enum class BalanceState { kEnforced, kNotStanding, kOff };
BalanceState decide_balance(BalanceMode mode, const Contact& contact);

// The hull of the contact as half planes, drawn in a little, so that the printed mesh, whose struts overlap,
// stands as well as the nominal model does: by kBalanceReserveMm, and by no more than half of what the solid
// itself has.
inline constexpr double kBalanceReserveMm = 0.3;
double balance_reserve_mm(const Contact& contact);
// Each half plane is a dense row of the optimiser: of a hull with more edges an inscribed polygon stands in.
inline constexpr int kMaxBalanceEdges = 24;
std::vector<HalfPlane> balance_half_planes(const Polygon2& hull, double reserve_mm);

struct PosedProblem {
  FrameProblem problem;
  std::vector<std::string> warnings;
};

Result<PosedProblem> pose_problem(const Solid& solid, const Contact& contact, const Skin& skin,
                                  const SampledFrame& sampled, const PrinterRequest& printer,
                                  const std::vector<Load>& loads, const JobOptions& options);

}  // namespace skinframe
