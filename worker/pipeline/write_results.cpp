// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/write_results.h"

#include <fmt/format.h>

#include "worker/mesh/write_stl.h"

namespace skinframe {

Status write_printable(const PrintableMesh& printable, const PreparedSolid& prepared,
                       const PrinterRequest& printer, const std::filesystem::path& folder,
                       PrinterReport* report) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return io_error(fmt::format("{}: {}", folder.string(), error.message()));
  if (auto written = write_stl(printable.mesh, folder / "skin-frame.stl"); !written) return written;
  report->voxel_mm = printable.voxel_mm;
  report->statistics.printed_volume_mm3 = printable.volume_mm3;
  report->statistics.printed_ratio = printable.volume_mm3 / prepared.solid.volume_mm3();
  report->statistics.weight_g = printable.volume_mm3 * printer.material.density_g_cm3 * 1e-3;
  return ok_status();
}

}  // namespace skinframe
