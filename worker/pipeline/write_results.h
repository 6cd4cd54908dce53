// SPDX-License-Identifier: GPL-3.0-or-later
// The meshes of one printer's folder, and the figures of what was written.
#pragma once

#include <filesystem>

#include "worker/frame/frame.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/pipeline/solve_and_merge.h"
#include "worker/report/report.h"
#include "worker/run/run_context.h"

namespace skinframe {

// skin-frame.stl, skin-frame.3mf and skin-frame-compact.stl; with a frame also frame-beams.3mf,
// with drain holes hole-caps.stl and hole-lids.stl (what is cut out of M). Fills the report's figures of the
// exported mesh and its list of files.
Status write_printable(const MergedPrint& print, const PreparedSolid& prepared, const PrinterRequest& printer,
                       const std::filesystem::path& folder, PrinterReport* report, const RunContext& context);

}  // namespace skinframe
