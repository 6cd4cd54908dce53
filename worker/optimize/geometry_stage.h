// SPDX-License-Identifier: GPL-3.0-or-later
// GeoOpt (21): where the internal nodes stand. Areas, positions, displacements and multipliers move together
// in one interior point; each node stays in its convex region (7) and in a box about its present place,
// struts stay slender enough and no shorter than a least length. Passes re-centre the regions; each is
// re-sized, and kept only when the volume falls and the caller accepts the moved frame.
#pragma once

#include "worker/optimize/design.h"
#include "worker/optimize/session.h"

namespace skinframe {

// The design itself, or a sized one of less volume with nodes moved. On cancellation: any of the two.
Design optimise_geometry(Design design, Session& session);

}  // namespace skinframe
