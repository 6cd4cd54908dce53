// SPDX-License-Identifier: GPL-3.0-or-later
// GeoOpt (21): where the internal nodes stand. Areas, positions, displacements and multipliers move together
// in one interior point; each node stays in its convex region (7) (where the caller gives none: in a box
// about its present place), struts stay slender enough and no shorter than a least length.
//
// Passes re-centre the regions. A pass takes part with the load case of the greatest demand; a case that the
// moved frame violates joins, and the pass is solved again. The moved frame is sized again, over all cases,
// and kept only when the volume falls and the caller accepts it; else the move is halved. Then struts that
// have become short are contracted (merge_nodes.h) where the sized result is no larger and keeps every
// constraint.
#pragma once

#include "worker/optimize/design.h"
#include "worker/optimize/session.h"

namespace skinframe {

struct GeometryOutcome {
  Design design;  // as it came, or a sized one of less volume with nodes moved
  bool settled =
      false;  // the last pass gained less than geometry_decrease, or nothing: more passes are no use
};

// On cancellation: any of the designs on the way.
GeometryOutcome optimise_geometry(Design design, Session& session);

}  // namespace skinframe
