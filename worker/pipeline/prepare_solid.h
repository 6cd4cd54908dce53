// SPDX-License-Identifier: GPL-3.0-or-later
// The stages that all printers share: read the mesh, place it, close it.
#pragma once

#include "worker/pipeline/request.h"
#include "worker/report/report.h"
#include "worker/run/run_context.h"
#include "worker/solid/contact.h"
#include "worker/solid/solid.h"

namespace skinframe {

struct PreparedSolid {
  Solid solid;  // on the plate: lowest z is 0, centred in x and y, up is +z
  Contact contact;
  MeshFacts facts;
};

Result<PreparedSolid> prepare_solid(const JobRequest& request, RunContext& context);

}  // namespace skinframe
