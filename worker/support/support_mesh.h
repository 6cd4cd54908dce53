// SPDX-License-Identifier: GPL-3.0-or-later
// Support struts as meshes: one closed shell a strut, a prism of kSides sides about its axis. Shells that
// meet at a node overlap there; slicers unite them.
//
// An external strut starts where its axis leaves M, a little within the skin, on a neck: it is broken off
// there. So it does where it ends on M; on the base plane it stands with its full radius.
//
// Guarantees: every edge has exactly two triangles, in opposite directions; coordinates are exact floats.
#pragma once

#include "worker/frame/frame.h"
#include "worker/mesh/triangle_mesh.h"
#include "worker/support/plan_supports.h"

namespace skinframe {

struct Neck {
  double radius_mm = 0.2;  // > 0
  double length_mm = 0.8;  // from M to the full radius
};

inline constexpr int kSides = 12;

TriangleMesh support_mesh(const Frame& frame, const SupportPlan& plan, SupportKind kind,
                          const PrintedBody& body, const Neck& neck);

}  // namespace skinframe
