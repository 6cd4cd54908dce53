// SPDX-License-Identifier: GPL-3.0-or-later
// What a result folder holds, read back from its files alone: report.json, and for each printer frame.json
// and skin-frame.stl, or for a frame problem result.json. Only the mesh reader is shared with the code that
// wrote them. Units as in the files: mm, N, MPa.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "worker/check/exported_drain.h"
#include "worker/check/exported_verification.h"
#include "worker/check/package.h"
#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"

namespace skinframe::check {

struct ExportedStrut {
  int a = 0, b = 0;
  bool skin = false;
  double radius_mm = 0, min_radius_mm = 0, max_radius_mm = 0;
};

struct ExportedLoadCase {
  std::string name;
  bool gravity = true;
  std::vector<Eigen::Vector3d> force_n;          // one a node
  std::vector<Eigen::Vector3d> displacement_mm;  // one a node; empty when the file has none
};

struct ExportedFrame {
  bool axial = false;  // the pin-jointed model in place of the paper's: no shear spring
  double tensile_modulus_mpa = 0, shear_modulus_mpa = 0, density_g_cm3 = 0;
  std::optional<double> tensile_strength_mpa, shear_strength_mpa, slenderness, displacement_limit_mm;
  std::vector<Eigen::Vector3d> nodes_mm;
  std::vector<ExportedStrut> struts;
  std::vector<std::array<int, 3>> skin_triangles;
  std::vector<std::array<bool, 3>> fixed;
  std::vector<double> skin_weight_n;
  std::vector<ExportedLoadCase> load_cases;
  double skin_mass_weight_n = 0;
  Eigen::Vector3d skin_centroid_mm = Eigen::Vector3d::Zero();
  // Balance as it was asked: normal . (x, y) <= offset.
  std::vector<std::pair<Eigen::Vector2d, double>> balance_half_planes;
};

// A proof about all radii within their bounds (see claims.h), in the file's own terms.
struct ExportedField {
  int load_case = 0;
  double displacement_multiplier = 0, stress_multiplier = 0;
  std::vector<Eigen::Vector3d> displacement_mm;  // one a node
};
struct ExportedProof {
  double volume_weight = 0, feasibility_tolerance = 0, value = 0;
  bool removable_may_vanish = false;
  std::vector<ExportedField> fields;
  std::vector<double> balance_multipliers;  // one a half plane, or empty
};

// What Algorithm 2 added, as frame.json and the report tell it. Nodes are counted behind those of the frame.
struct ExportedSupportNode {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  std::string on;  // "strut", "roof", "support", "skin", "plate"
  int strut = -1;  // of the frame, for "strut"
};
struct ExportedSupportStrut {
  int upper = 0, lower = 0;
  double radius_mm = 0;
  bool external = false;
};
struct ExportedSupports {
  std::vector<std::pair<double, double>>
      printable_length;  // degrees from the vertical, mm; infinite: no limit
  double self_supporting_angle_deg = 0, plate_z_mm = 0, plate_reach_mm = 0, skin_tie_radius_mm = 0;
  std::vector<ExportedSupportNode> nodes;
  std::vector<ExportedSupportStrut> struts;
  // as reported
  int internal = 0, external = 0, count = 0;
  double length_mm = 0, volume_mm3 = 0, internal_volume_mm3 = 0, external_volume_mm3 = 0, weight_g = 0;
  double worst_vertical_deformation_mm = 0;
  std::optional<double> deformation_limit_mm;
  double roof_beyond_mm2 = 0, underside_beyond_mm2 = 0, cavity_surface_mm2 = 0, beyond_share = 0;
  TriangleMesh all_mesh, internal_mesh, external_mesh;  // empty where there is no such file
};

// Radii and lengths of the struts before the optimiser and after each of its stages but the last.
struct ExportedStage {
  std::string name;  // "initial", "size", "topology"
  std::vector<double> radii_mm, lengths_mm;
  int struts = 0;                    // as reported, as is the volume
  std::optional<double> volume_mm3;  // none is reported of a mesh job's initial frame
};

struct ExportedPrinter {
  std::string printer, material;
  std::string termination;  // "OPTIMAL", "INFEASIBLE", "SOLID", ...
  double solid_volume_mm3 = 0, skin_volume_mm3 = 0, frame_volume_mm3 = 0, total_volume_mm3 = 0, ratio = 0;
  double printed_volume_mm3 = 0, printed_ratio = 0, weight_g = 0;
  double size_volume_mm3 = 0, topology_volume_mm3 = 0, geometry_volume_mm3 = 0;
  double max_displacement_mm = 0, max_axial_ratio = 0, max_shear_ratio = 0, min_radius_mm = 0;
  std::optional<double> balance_margin_mm, printed_balance_margin_mm, lower_bound_mm3,
      best_reachable_displacement_mm;
  std::optional<double> gap, relaxed_lower_bound_mm3, relaxed_gap;
  bool infeasibility_proven = false;         // as the report says
  std::optional<ExportedProof> certificate;  // of `frame`
  // The frame that the optimiser was given, and what proves the bounds for it.
  std::optional<ExportedFrame> given;
  std::optional<ExportedProof> bound_proof, relaxed_bound_proof;
  std::string balance, violated_constraint;
  int final_nodes = 0, final_struts = 0;
  std::vector<ExportedStage> stages;       // empty where the file has none
  std::optional<double> added_skin_mm3;    // by smoothing; none where it was not applied
  std::optional<int> skin_struts_outside;  // as reported; none in a report that says nothing about it
  // profile
  double eta_mm = 0, skin_thickness_mm = 0, max_internal_radius_mm = 0, voxel_mm = 0;
  double density_g_cm3 = 0;
  Eigen::Vector3d tray_mm = Eigen::Vector3d::Zero();
  std::size_t solid_triangles =
      0;                      // of the merged mesh's first ones, that are M's or, at holes, parts of M's
  std::size_t crossings = 0;  // pairs of triangles, beside the input's own, that are said to cut each other
  ExportedFrame frame;
  std::optional<TriangleMesh> merged;  // vertices welded where equal; absent where the result has no mesh
  std::optional<TriangleMesh> compact;
  std::optional<Package> package, beams;  // skin-frame.3mf, frame-beams.3mf
  std::optional<ExportedSupports> supports;
  std::optional<ExportedVerification> verification;
  std::optional<ExportedDrain> drain;  // of printers whose profile has a rule for drain holes
  std::size_t compact_triangles = 0, compact_crossings = 0;
  double compact_volume_mm3 = 0, compact_deviation_mm = 0;
  bool optimised() const { return termination != "NOT_OPTIMIZED"; }
  bool infeasible() const { return termination == "INFEASIBLE"; }
  bool solid() const { return termination == "SOLID"; }  // thin everywhere: no frame, no frame.json
};

// How the body was put down, where the best attitude was asked for.
struct ExportedAttitude {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // of the body as the file has it
  double support_estimate_mm3 = 0, standing_margin_mm = 0;
};
struct ExportedOrientation {
  std::string printer;  // whose curve and radii it was ranked by
  ExportedAttitude chosen;
  std::optional<ExportedAttitude> runner_up;
};

struct Exported {
  std::vector<ExportedPrinter> printers;
  std::optional<ExportedOrientation> orientation;  // none: not asked for, or nothing to rank by
  // The result of a frame problem: report.json's "frame" and result.json. Of ExportedPrinter the fields that
  // a frame has; printer is "frame", solid, skin and mesh are not there.
  std::optional<ExportedPrinter> solution;
};

// Errors: kIo and kInvalidInput, naming file and field.
Result<Exported> read_exported(const std::filesystem::path& directory, RunContext& context);

// Vertices at exactly the same place become one.
TriangleMesh weld_equal(const TriangleMesh& soup);

}  // namespace skinframe::check
