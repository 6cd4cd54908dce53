// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/write_results.h"

#include <fmt/format.h>

#include <optional>

#include "worker/export/compact_mesh.h"
#include "worker/export/write_3mf.h"
#include "worker/mesh/write_stl.h"
#include "worker/pipeline/side_by_side.h"

namespace skinframe {
namespace {

constexpr double kCapClearanceInRadii = 0.5;       // of the least printable radius, between cap and hole
constexpr double kCompactDeviationInSkins = 0.25;  // of the skin's thickness

ThreemfText text_of(const std::string& object, const PreparedSolid& prepared, const PrinterReport& report) {
  return {object, prepared.facts.name,
          fmt::format("{} of {}: skin {:.3g} mm, printer {}, material {}, {:.1f} % of the solid", object,
                      prepared.facts.name, report.skin_thickness_mm, report.printer, report.material,
                      100.0 * report.statistics.printed_ratio)};
}

Result<CompactMesh> compact_of(const MergedPrint& print, const PreparedSolid& prepared,
                               const PrinterReport& report, const RunContext& context) {
  CompactOptions options;
  options.max_deviation_mm = kCompactDeviationInSkins * report.skin_thickness_mm;
  return make_compact(print.closed, prepared.solid.mesh().triangles.size(), options, context);
}

Status write_compact(CompactMesh compact, const MergedPrint& print, const std::filesystem::path& folder,
                     PrinterReport* report) {
  if (print.opened) {
    OpenedMesh opened = open_holes(compact.mesh, compact.outer_triangles, print.opened->openings);
    if (!opened.uncut.empty()) {
      report->warnings.push_back("no compact mesh is written: its drain holes could not be cut");
      return ok_status();
    }
    compact.mesh = std::move(opened.mesh);
    compact.volume_mm3 = opened.volume_mm3;
  }
  if (auto written = write_stl(compact.mesh, folder / "skin-frame-compact.stl"); !written) return written;
  report->compact = {compact.mesh.triangles.size(), compact.volume_mm3, compact.deviation_mm,
                     compact.crossings_left};
  report->files.push_back("skin-frame-compact.stl");
  return ok_status();
}

std::string at_place(const Eigen::Vector3d& p) {
  return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", p.x(), p.y(), p.z());
}

void warn_of_what_stays(const DrainFacts& drain, const OpenedMesh* opened, PrinterReport* report) {
  if (opened != nullptr)
    for (const Opening& opening : opened->uncut)
      report->warnings.push_back(fmt::format(
          "the drain hole at {} could not be cut: the mesh there is no single sheet of skin, or struts stand "
          "in its way",
          at_place(opening.centre_mm)));
  if (drain.sealed.empty()) return;
  double volume = 0;
  for (const SealedVoid& sealed : drain.sealed) volume += sealed.volume_mm3;
  report->warnings.push_back(fmt::format(
      "cannot be emptied: {} hollow{} ({:.3g} mm3 together) that no drain hole reaches; what fills {} while "
      "printing stays; the largest, {:.3g} mm3, is about {}",
      drain.sealed.size(), drain.sealed.size() == 1 ? "" : "s", volume,
      drain.sealed.size() == 1 ? "it" : "them", drain.sealed[0].volume_mm3,
      at_place(drain.sealed[0].centre_mm)));
}

// Caps and lids, and what is said of the holes.
Status write_holes(const MergedPrint& print, const PreparedSolid& prepared, const DrainHoleRule& rule,
                   const std::filesystem::path& folder, PrinterReport* report) {
  DrainFacts& drain = report->drain.emplace();
  drain.rule_diameter_mm = rule.diameter_mm;
  drain.rule_least_count = rule.least_count;
  drain.sealed = find_sealed_voids(print.mesh());
  drain.outer_triangles = prepared.solid.mesh().triangles.size();
  const OpenedMesh* opened = print.opened ? &*print.opened : nullptr;
  warn_of_what_stays(drain, opened, report);
  if (opened != nullptr) drain.uncut = opened->uncut;
  if (opened == nullptr || opened->openings.empty()) return ok_status();
  drain.outer_triangles = opened->outer_triangles;
  drain.openings = opened->openings;
  drain.cap_clearance_mm = kCapClearanceInRadii * report->min_radius_mm;
  const TriangleMesh caps = make_caps(prepared.solid.mesh(), opened->openings, report->skin_thickness_mm,
                                      drain.cap_clearance_mm, &drain.caps);
  if (drain.caps < static_cast<int>(opened->openings.size()))
    report->warnings.push_back(
        fmt::format("{} of {} drain holes have no cap: it could not be cut from the surface",
                    opened->openings.size() - drain.caps, opened->openings.size()));
  if (auto written = write_stl(opened->lids, folder / "hole-lids.stl"); !written) return written;
  report->files.push_back("hole-lids.stl");
  if (drain.caps > 0) {
    if (auto written = write_stl(caps, folder / "hole-caps.stl"); !written) return written;
    report->files.push_back("hole-caps.stl");
  }
  return ok_status();
}

// The mesh in both formats, and the frame alone where there is one.
Status write_full(const MergedPrint& print, const PreparedSolid& prepared,
                  const std::filesystem::path& folder, const PrinterReport& report) {
  if (auto written = write_stl(print.mesh(), folder / "skin-frame.stl"); !written) return written;
  if (auto written =
          write_3mf(print.mesh(), text_of("skin-frame", prepared, report), folder / "skin-frame.3mf");
      !written)
    return written;
  if (!report.optimised) return ok_status();
  return write_beams_3mf(report.optimised->problem.frame, report.optimised->radii_mm,
                         text_of("frame", prepared, report), folder / "frame-beams.3mf");
}

}  // namespace

Status write_printable(const MergedPrint& print, const PreparedSolid& prepared, const PrinterRequest& printer,
                       const std::filesystem::path& folder, PrinterReport* report,
                       const RunContext& context) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return io_error(fmt::format("{}: {}", folder.string(), error.message()));
  const PrintableMesh& printable = print.closed;
  report->voxel_mm = printable.voxel_mm;
  report->triangles = print.mesh().triangles.size();
  report->crossings = printable.crossings_left;
  report->statistics.printed_volume_mm3 = print.volume_mm3();
  report->statistics.printed_ratio = print.volume_mm3() / prepared.solid.volume_mm3();
  report->statistics.weight_g = print.volume_mm3() * printer.material.density_g_cm3 * 1e-3;
  if (printable.crossings_left > 0)
    report->warnings.push_back(fmt::format(
        "{} pairs of triangles cut each other that the input did not bring; slicers take it, another --voxel "
        "may avoid it",
        printable.crossings_left));

  // The compact mesh takes longest by far, and all threads: made beside, it would have one only. The full
  // one's files are written beside it; where there is one thread before it, since they tell of a disk that
  // fails.
  std::optional<CompactMesh> compact;
  const JobPart full = [&](const RunContext&) { return write_full(print, prepared, folder, *report); };
  const JobPart thin = [&](const RunContext& stopping) -> Status {
    auto thinned = compact_of(print, prepared, *report, stopping);
    if (!thinned) return thinned.error();
    compact = std::move(thinned).value();
    return ok_status();
  };
  const Status made =
      context.threads > 1 ? side_by_side(thin, full, context) : side_by_side(full, thin, context);
  if (!made) return made;
  report->files.insert(report->files.end(), {"skin-frame.stl", "skin-frame.3mf"});
  if (report->optimised) report->files.push_back("frame-beams.3mf");
  const auto rule = printer.printer.holes_to_make();
  if (rule && !report->is_solid) {
    if (auto written = write_holes(print, prepared, *rule, folder, report); !written) return written;
  }
  return write_compact(std::move(*compact), print, folder, report);
}

}  // namespace skinframe
