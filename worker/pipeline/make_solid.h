// SPDX-License-Identifier: GPL-3.0-or-later
// A body that is thinner than two skins everywhere: there is nothing to hollow, so it is printed as it is.
#pragma once

#include <filesystem>

#include "worker/pipeline/pose_problem.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/report/report.h"
#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

// Writes M itself and fills the report: ratio 1, no nodes, no struts, a warning that says why. Balance is
// that of the solid; with `require` and a solid that does not stand the report is INFEASIBLE and nothing is
// written.
Status make_solid(const PreparedSolid& prepared, const Skin& skin, const PrinterRequest& printer,
                  const JobOptions& options, const std::filesystem::path& folder, PrinterReport* report,
                  const RunContext& context);

}  // namespace skinframe
