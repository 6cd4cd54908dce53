// SPDX-License-Identifier: GPL-3.0-or-later
// report.json: what a job tells its user, one object a printer. Nominal figures (the paper's: sum of pi r^2 l
// plus skin) and those of the exported mesh stand apart; figures of the paper's mechanical model are named so
// in "model". A field is there when its value is known; nothing is guessed.
//
// "lower_bound_mm3": no radii within their bounds on the initial nodes and struts keep the limits with less
// frame volume; "gap": size_volume_mm3 / it - 1. "relaxed_lower_bound_mm3", "relaxed_gap": the same where
// removable struts may also be absent, against topology_volume_mm3. Nodes stand where they were sampled:
// neither bounds what geometry optimisation reaches by moving them. "infeasibility_proven": whether
// frame.json has a certificate that no radii keep the limits.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "worker/export/open_holes.h"
#include "worker/export/printable.h"
#include "worker/frame/sample_frame.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/skin/build_skin.h"
#include "worker/solid/contact.h"
#include "worker/solid/solid.h"
#include "worker/support/overhang.h"
#include "worker/support/print_state.h"
#include "worker/verify/verification.h"

namespace skinframe {

// Why a printer's part ended as it did; names of the wire by to_string().
enum class Reason {
  kNone,
  kPartial,
  kInvalidInput,
  kDoesNotFit,
  kInfeasible,
  kOutOfMemory,
  kInternal,
  kCancelled,
  kUnsupported,
};
const char* to_string(Reason reason);  // "NONE", "PARTIAL", "INVALID_INPUT", ...
Reason reason_of(ErrorKind kind);

// How --orient best put the body down: by an estimate on its surface (support/orient_body.h).
struct OrientationFacts {
  struct Tried {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // of the body as the file and --up have it
    double support_estimate_mm3 = 0;
    double margin_mm = 0;  // of the solid's centroid inside its base contact
  };
  std::string printer;                     // whose curve and radii it was ranked by
  std::optional<Tried> chosen, runner_up;  // no choice: nothing to rank by, or nothing that fits
  int candidates = 0;
  int passed_over = 0;  // better ones that do not fit every tray
};

struct MeshFacts {
  std::string name, format;
  std::vector<std::string> repairs, warnings;
  std::optional<OrientationFacts> orientation;  // with --orient best
};
// The "mesh" object, of the placed and repaired solid.
nlohmann::json mesh_json(const MeshFacts& facts, const Solid& solid, const Contact& contact);

// Nominal and printed figures of one printer: the row of the paper's Table 2, and the statistics of the wire.
struct Statistics {
  double solid_volume_mm3 = 0, skin_volume_mm3 = 0, frame_volume_mm3 = 0, total_volume_mm3 = 0, ratio = 0;
  double printed_volume_mm3 = 0, printed_ratio = 0, weight_g = 0;
  int skin_nodes = 0, nodes = 0, struts = 0;
  double max_displacement_mm = 0;
  std::string balance;                      // "holds", "not_standing", "off", "not_claimed"
  std::optional<double> balance_margin_mm;  // of the nominal centre of gravity inside the base contact
  std::optional<double> printed_balance_margin_mm;  // of the exported mesh's
  nlohmann::json verified;                          // verified_summary_json(); null where it is not verified
  std::string not_verified;                         // why not, where that model was asked and has no answer
};
nlohmann::json to_json(const Statistics& statistics);

// Of skin-frame-compact.stl.
struct CompactFacts {
  std::size_t triangles = 0;
  double volume_mm3 = 0, deviation_mm = 0;  // deviation from skin-frame.stl
  int crossings = 0;                        // pairs of its triangles that cut each other
};

// How the frame's nodes were placed, as measured on the initial frame: the "sampling" object.
struct SamplingFacts {
  std::string density;  // "stress+curvature" or "curvature"
  int skin_nodes_requested = 0, skin_nodes_sampled = 0;
  int skin_nodes = 0;  // after struts that left M1 were divided
  int internal_nodes = 0;
  TriangleAngles angles;
  double worst_outward_chord_mm = 0, worst_inward_chord_mm = 0;  // of skin struts from M1
  int skin_struts_outside = 0;                                   // whose axis leaves M
  int struts_left_out_crossing = 0;
  std::optional<int> stress_tetrahedra;
  std::optional<double> stress_largest_mpa;  // of the solid, at a vertex of the map
};

// What became of detail finer than the skin: the "smoothing" object, there unless it was off.
struct SmoothingFacts {
  bool applied = false;
  FineDetail detail;
  double added_skin_mm3 = 0;  // deeper than h_S below M, but not below its smooth copy
};

// What of an earlier job served this printer's part.
struct WarmStartReport {
  std::string job_id;
  std::vector<std::string>
      reused;          // of "sampled frame", "reduced frame", "radii"; none: it ran as without it
  std::string detail;  // why not all of them, where it is not all
};

// Of the exported support struts. A node where struts end on each other is counted in the volume of each.
struct SupportFacts {
  int internal = 0, external = 0;  // struts
  double length_mm = 0;            // of their axes
  double internal_volume_mm3 = 0, external_volume_mm3 = 0, weight_g = 0;
};

// Of the drain holes: the "drain_holes" object, there where the printer's profile has a rule for them.
struct DrainFacts {
  double rule_diameter_mm = 0;
  int rule_least_count = 0;
  std::vector<Opening> openings;  // as cut
  std::vector<Opening> uncut;     // the frame has their rims, but the skin is closed there
  std::size_t outer_triangles =
      0;                        // of skin-frame.stl: its first ones, which with hole-lids.stl are M's surface
  int caps = 0;                 // in hole-caps.stl, as thick as the skin
  double cap_clearance_mm = 0;  // of their radius within the hole's
  std::vector<SealedVoid> sealed;  // what no hole reaches, the largest first
};

struct PlannedSupports {
  SupportPlan plan;
  PrintState state;
  Overhang overhang;              // of the skin, with the supports in place
  double cavity_surface_mm2 = 0;  // of M1
  SupportFacts facts;             // once they are written
};
nlohmann::json to_json(const PlannedSupports& supports);

// Everything that is known when one printer's part ends, by result or by a bound that cannot be kept.
struct PrinterReport {
  std::string printer, material;
  double min_radius_mm = 0, skin_thickness_mm = 0, max_internal_radius_mm = 0, density_g_cm3 = 0;
  Eigen::Vector3d tray_mm = Eigen::Vector3d::Zero();
  std::optional<double> price_per_kg;
  Reason reason = Reason::kNone;
  std::string detail;
  Statistics statistics;
  std::string termination;  // "OPTIMAL", "ITERATION_LIMIT", "NOT_OPTIMIZED", "INFEASIBLE", "SOLID", ...
  std::string termination_detail;
  std::optional<SamplingFacts> sampling;
  std::optional<OptimizeResult> optimised;
  std::optional<ThinParts> thin;  // once the skin is built
  std::optional<SmoothingFacts> smoothing;
  bool is_solid = false;           // thin everywhere: printed as it is, without a frame
  std::optional<double> voxel_mm;  // of the exported mesh
  std::size_t triangles = 0;       // of the exported mesh
  int crossings = 0;               // pairs of its triangles that cut each other, beside M's own
  std::optional<CompactFacts> compact;
  std::vector<std::string> files;  // in the printer's folder
  std::vector<std::string> warnings;
  std::optional<WarmStartReport> warm_start;
  std::optional<PlannedSupports> supports;   // of extrusion printers
  std::optional<Verification> verification;  // by the valid model
  std::optional<DrainFacts> drain;           // of powder and resin printers
  std::map<std::string, double> seconds;
};
nlohmann::json to_json(const PrinterReport& report);

// A refused printer has a reason and nothing to measure.
nlohmann::json refused_json(const PrinterReport& report);

}  // namespace skinframe
