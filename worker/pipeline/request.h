// SPDX-License-Identifier: GPL-3.0-or-later
// What a job asks for, as the pipeline takes it: a mesh file, printers with their materials, loads and
// options. Nothing of the wire is here; worker/job reads it from job.json. Units: mm, N, MPa, g/cm3.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "worker/mechanics/frame_problem.h"
#include "worker/profile/printable_length.h"
#include "worker/skin/fine_detail.h"
#include "worker/solid/place.h"

namespace skinframe {

enum class PrintProcess { kPowder, kExtrusion, kResin };

// Where the layers grow to: away from the ground, or towards it with the part hanging from the plate.
enum class BuildDirection { kUp, kHanging };

// Holes through which powder or resin leaves the cavity.
struct DrainHoleRule {
  double diameter_mm = 0;
  int least_count = 0;           // of the largest cavity
  double least_diameter_mm = 0;  // where the diameter has no room, > 0 and at most that
};

struct PrinterProfile {
  std::string id;
  PrintProcess process = PrintProcess::kPowder;
  double min_radius_mm = 0;  // eta in Table 1; the skin is twice as thick
  Eigen::Vector3d tray_mm = Eigen::Vector3d::Zero();
  double max_internal_radius_mm = 5;                // upper bound of (10)
  std::optional<PrintableLength> printable_length;  // p(theta) of 4.5; none: no limit
  std::optional<DrainHoleRule> drain_holes;         // as the profile says; see holes_to_make()
  BuildDirection build_direction = BuildDirection::kUp;
  std::optional<double> neck_diameter_mm;  // of an external support strut at the skin, where it is broken off

  double skin_thickness_mm() const { return 2 * min_radius_mm; }  // h_S
  // None where nothing is to be drained: in extrusion, whose support struts may stand anywhere on the skin.
  std::optional<DrainHoleRule> holes_to_make() const {
    return process == PrintProcess::kExtrusion ? std::nullopt : drain_holes;
  }
};

struct PrinterRequest {
  PrinterProfile printer;
  Material material;
  std::optional<double> price_per_kg;
};

// Where the surface is furthest in one direction, up being +z and the front -y.
enum class Place { kTop, kBottom, kLeft, kRight, kFront, kBack };

// One external force, spread over a round patch of the skin. Loads of one name act together as one load case.
struct Load {
  std::string name;
  std::variant<Place, Eigen::Vector3d> where =
      Place::kTop;  // a point: in the coordinates of the placed object
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
  double radius_mm = 5;
};

enum class BalanceMode { kAuto, kRequire, kOff };
enum class Orient { kKeep, kBest };
enum class StageOrder { kTight, kPaper };

struct JobOptions {
  Up up = Up::kZ;
  BalanceMode balance = BalanceMode::kAuto;
  std::optional<double> size_mm;  // largest edge of the bounding box; none: the file is in mm
  std::optional<int> skin_nodes, internal_nodes;
  std::optional<double> voxel_mm;  // of the final solid
  Smooth smooth = Smooth::kAuto;   // of detail finer than the skin
  bool no_optimize = false;        // radii stay at their lower bounds
  bool verify = true;              // analyse the result by the valid model too
  StageOrder order = StageOrder::kTight;
  Orient orient = Orient::kKeep;
  double displacement_limit_mm = 0.05;  // epsilon of (6)
  std::uint64_t seed = 1;
};

// An earlier job of the same mesh, and the initial-frame.json of each of its printers.
struct EarlierJob {
  std::string job_id;
  std::map<std::string, std::filesystem::path> files;  // by printer id
};

struct JobRequest {
  std::string job_id;
  std::filesystem::path mesh_path;
  std::string mesh_name;  // for people
  std::vector<PrinterRequest> printers;
  std::vector<Load> loads;
  JobOptions options;
  std::optional<EarlierJob> warm_start;
};

}  // namespace skinframe
