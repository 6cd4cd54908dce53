// SPDX-License-Identifier: GPL-3.0-or-later
// Algorithm 2 of Wang et al. 2013, section 4.5: the support struts of a finished frame.
//
//   divide   each strut longer than p(theta) of its angle gets ceil(l / p) - 1 equidistant nodes
//   hold     each of these nodes, each node of the frame that no strut leads down from, and each roof point
//   is
//            joined by a self-supporting strut to the nearest place below that prints: a node, a place on
//            another support, the floor of the cavity; outside of M where nothing within serves, down to the
//            base plane or to M below
//
// Each of them gets one support and only where it has no other way down, so that none is useless.
//
// A node needs no support of its own within plate_reach_mm of the base plane, nor in a wall no flatter than
// self_supporting_angle(curve): the skin below it holds it. (A roof point in such a wall does: it stands
// where the wall ends below.) A support within M that comes to such a wall ends there.
//
// Guarantees:
//  1. Every strut of the frame, divided at its nodes, and every support strut satisfies l <= p(theta).
//  2. Every support strut leads down, at no more than the self-supporting angle from the vertical. So every
//     node has a way down, by struts of which each ends lower, or by the skin.
//  3. Internal struts stay within M, external ones outside of it but for their ends in the skin.
//  4. Without any one support strut some node has no way down: a strut that it divides would be too long, or
//  a
//     node would start in the air.
//  5. Same input, same plan.
#pragma once

#include <optional>
#include <vector>

#include "worker/frame/frame.h"
#include "worker/run/result.h"
#include "worker/run/run_context.h"
#include "worker/support/printable_curve.h"
#include "worker/support/printed_body.h"
#include "worker/support/support_plan.h"

namespace skinframe {

struct SupportOptions {
  double min_radius_mm = 0.4;         // eta
  std::optional<double> slenderness;  // alpha of (4): radius of a support >= its whole length / alpha
  double plate_reach_mm = 1.0;        // height over the base plane up to which the plate holds a node
  std::vector<Eigen::Vector3d> roof_points;
  std::size_t most_nodes = 20'000;  // a bound on what is added
};

// Errors: kInvalidInput when more nodes than most_nodes would be needed; kCancelled.
Result<SupportPlan> plan_supports(const Frame& frame, const PrintableLength& curve, const PrintedBody& body,
                                  const SupportOptions& options, const RunContext& context);

// The nodes of a strut of the frame from a to b, those that divide it among them.
std::vector<std::vector<int>> divided_struts(const Frame& frame, const SupportPlan& plan);

// Frame and plan share their node indices.
inline const Eigen::Vector3d& node_mm(const Frame& frame, const SupportPlan& plan, int node) {
  const int own = static_cast<int>(frame.nodes_mm.size());
  return node < own ? frame.nodes_mm[node] : plan.nodes[node - own].at_mm;
}

}  // namespace skinframe
