// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/verify_result.h"

#include <fmt/format.h>

#include "worker/pipeline/place_loads.h"
#include "worker/report/verification_json.h"
#include "worker/verify/verify.h"
#include "worker/verify/write_maps.h"

namespace skinframe {

Result<Verification> verify_result(const PreparedSolid& prepared, const Skin& skin, const JobRequest& job,
                                   const OptimizeResult& result, double printed_volume_mm3,
                                   const RunContext& context) {
  VerifyInput input{.problem = result.problem,
                    .radii_mm = result.radii_mm,
                    .skin = skin,
                    .body = prepared.solid.mesh(),
                    .solid_volume_mm3 = prepared.solid.volume_mm3(),
                    .printed_volume_mm3 = printed_volume_mm3,
                    .place_loads = {},
                    .loads = loads_at_points(job.loads, prepared.solid)};
  input.place_loads = [&](const Frame& frame) -> Result<std::vector<LoadCase>> {
    auto placed = place_loads(job.loads, prepared.solid, frame);
    if (!placed) return placed.error();
    return std::move(placed.value().cases);
  };
  return verify(input, context);
}

Status report_verification(Result<Verification> verified, const std::filesystem::path& folder,
                           PrinterReport* report) {
  if (!verified) {
    if (verified.error().kind == ErrorKind::kCancelled) return verified.error();
    report->statistics.not_verified = verified.error().message;
    report->warnings.push_back(
        fmt::format("not verified: the model of shell and struts has no answer for this frame ({}); only the "
                    "paper's model speaks for it",
                    verified.error().message));
    return ok_status();
  }
  report->verification = std::move(verified).value();
  if (report->verification->mesh_error > kMeshTolerance)
    report->warnings.push_back("verified figures: " + mesh_words(*report->verification));
  report->statistics.verified = verified_summary_json(*report->verification);
  for (const Deformation& deformation : report->verification->deformations) {
    const std::string name = fmt::format("deformation-{}.ply", deformation.name);
    if (auto written = write_deformation(*report->verification, deformation, folder / name); !written)
      return written;
    report->files.push_back(name);
  }
  if (report->verification->ours.pinch) {
    if (auto written = write_pinch_map(*report->verification, folder / "pinch.ply"); !written) return written;
    report->files.push_back("pinch.ply");
  }
  return ok_status();
}

}  // namespace skinframe
