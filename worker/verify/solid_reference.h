// SPDX-License-Identifier: GPL-3.0-or-later
// The body as a solid, by quadratic tetrahedra cut from the distance field: displacements and pinches only.
#pragma once

#include "worker/verify/pinch.h"
#include "worker/verify/verify.h"

namespace skinframe {

// Held is the surface within kContactToleranceMm of the plate. Errors: those of the tetrahedra and their
// solution.
Result<DesignFigures> assess_solid(const VerifyInput& input, const FineSkin& fine,
                                   const std::vector<PinchSite>& pinches, const RunContext& context);

}  // namespace skinframe
