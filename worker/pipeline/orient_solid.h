// SPDX-License-Identifier: GPL-3.0-or-later
// --orient best: the closed body put down in the attitude that needs the least support and fits every tray.
#pragma once

#include "worker/pipeline/request.h"
#include "worker/report/report.h"
#include "worker/solid/solid.h"

namespace skinframe {

struct OrientedSolid {
  Solid solid;  // on the plate, up is +z
  OrientationFacts facts;
};

// Ranked by the printable length of the job's first extrusion printer; a job without one keeps the body as it
// is. Attitudes that do not fit the tray of every printer are passed over; the body's own is not.
Result<OrientedSolid> orient_solid(const Solid& solid, const JobRequest& request);

}  // namespace skinframe
