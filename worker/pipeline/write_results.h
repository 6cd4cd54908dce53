// SPDX-License-Identifier: GPL-3.0-or-later
// The meshes of one printer's folder, and the figures of what was written.
#pragma once

#include <filesystem>

#include "worker/pipeline/prepare_solid.h"
#include "worker/report/report.h"

namespace skinframe {

// skin-frame.stl; fills the report's figures of the exported mesh.
Status write_printable(const PrintableMesh& printable, const PreparedSolid& prepared,
                       const PrinterRequest& printer, const std::filesystem::path& folder,
                       PrinterReport* report);

}  // namespace skinframe
