// SPDX-License-Identifier: GPL-3.0-or-later
// The supports of one printer's frame: planned for printers with a printable length, merged where they stay,
// and written. In frame.json:
//
//   "supports": {"printable_length": [{"angle_deg", "length_mm" or null}..], "self_supporting_angle_deg",
//                "plate_z_mm", "plate_reach_mm", "neck_diameter_mm", "skin_tie_radius_mm",
//                "nodes": [{"at_mm": [x,y,z], "on": "strut|roof|support|skin|plate", "strut": j or -1}..],
//                "struts": [{"a": upper, "b": lower, "radius_mm", "support": "internal|external"}..]}
//
// where the nodes of the frame are counted first. The frame's own struts stand undivided beside it, so that
// the file stays the problem that was optimised.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "worker/pipeline/request.h"
#include "worker/report/report.h"
#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

// Height over the base plane up to which it holds a node of the skin: the skin, and the contact tolerance.
double plate_reach_mm(const Skin& skin);

// None for printers that need no supports. mesh: M. A warning where (22) does not hold.
Result<std::optional<PlannedSupports>> plan_print(const FrameProblem& problem,
                                                  const std::vector<double>& radii_mm,
                                                  const TriangleMesh& mesh, const Skin& skin,
                                                  const PrinterProfile& printer, const RunContext& context);

// The frame with what of the supports stays, for the merge.
struct MergedFrame {
  Frame frame;
  std::vector<double> radii_mm;
};
MergedFrame with_internal_supports(const Frame& frame, const std::vector<double>& radii_mm,
                                   const SupportPlan* plan);

nlohmann::json supports_json(const PlannedSupports& supports, const PrinterProfile& printer,
                             const Skin& skin);

// support-struts.stl and, of each kind that there is, support-struts-internal.stl and -external.stl. Fills
// the report's figures and its list of files.
Status write_supports(const Frame& frame, const Skin& skin, const PrinterRequest& printer,
                      const std::filesystem::path& folder, PrinterReport* report);

}  // namespace skinframe
