// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/write_results.h"

#include <fmt/format.h>

#include "worker/export/compact_mesh.h"
#include "worker/export/write_3mf.h"
#include "worker/mesh/write_stl.h"

namespace skinframe {
namespace {

constexpr double kCompactDeviationInSkins = 0.25;  // of the skin's thickness

ThreemfText text_of(const std::string& object, const PreparedSolid& prepared, const PrinterReport& report) {
  return {object, prepared.facts.name,
          fmt::format("{} of {}: skin {:.3g} mm, printer {}, material {}, {:.1f} % of the solid", object,
                      prepared.facts.name, report.skin_thickness_mm, report.printer, report.material,
                      100.0 * report.statistics.printed_ratio)};
}

Status write_compact(const PrintableMesh& printable, const PreparedSolid& prepared,
                     const std::filesystem::path& folder, PrinterReport* report, const RunContext& context) {
  CompactOptions options;
  options.max_deviation_mm = kCompactDeviationInSkins * report->skin_thickness_mm;
  auto compact = make_compact(printable, prepared.solid.mesh().triangles.size(), options, context);
  if (!compact) return compact.error();
  if (auto written = write_stl(compact->mesh, folder / "skin-frame-compact.stl"); !written) return written;
  report->compact = {compact->mesh.triangles.size(), compact->volume_mm3, compact->deviation_mm,
                     compact->crossings_left};
  report->files.push_back("skin-frame-compact.stl");
  return ok_status();
}

}  // namespace

Status write_printable(const PrintableMesh& printable, const PreparedSolid& prepared,
                       const PrinterRequest& printer, const std::filesystem::path& folder,
                       PrinterReport* report, const RunContext& context) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return io_error(fmt::format("{}: {}", folder.string(), error.message()));
  report->voxel_mm = printable.voxel_mm;
  report->triangles = printable.mesh.triangles.size();
  report->crossings = printable.crossings_left;
  report->statistics.printed_volume_mm3 = printable.volume_mm3;
  report->statistics.printed_ratio = printable.volume_mm3 / prepared.solid.volume_mm3();
  report->statistics.weight_g = printable.volume_mm3 * printer.material.density_g_cm3 * 1e-3;
  if (printable.crossings_left > 0)
    report->warnings.push_back(fmt::format(
        "{} pairs of triangles cut each other that the input did not bring; slicers take it, another --voxel "
        "may avoid it",
        printable.crossings_left));

  if (auto written = write_stl(printable.mesh, folder / "skin-frame.stl"); !written) return written;
  if (auto written =
          write_3mf(printable.mesh, text_of("skin-frame", prepared, *report), folder / "skin-frame.3mf");
      !written)
    return written;
  report->files.insert(report->files.end(), {"skin-frame.stl", "skin-frame.3mf"});
  if (context.cancelled()) return cancelled_error();
  if (report->optimised) {
    if (auto written = write_beams_3mf(report->optimised->problem.frame, report->optimised->radii_mm,
                                       text_of("frame", prepared, *report), folder / "frame-beams.3mf");
        !written)
      return written;
    report->files.push_back("frame-beams.3mf");
  }
  return write_compact(printable, prepared, folder, report, context);
}

}  // namespace skinframe
