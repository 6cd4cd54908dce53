// SPDX-License-Identifier: GPL-3.0-or-later
// The report's "verification", and deformation-NAME.ply and pinch.ply beside it, read back by the check's own
// few lines.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "worker/run/result.h"

namespace skinframe::check {

struct ExportedDeformation {
  std::string load;  // of the file's name
  std::vector<Eigen::Vector3d> at_mm, displacement_mm;
  std::size_t triangles = 0;
};

struct ExportedPinch {
  std::vector<Eigen::Vector3d> at_mm;
  std::vector<double> closing_mm;  // at the vertices
};

struct ExportedPinchSite {
  std::array<Eigen::Vector3d, 2> fingers_mm;
  double closing_mm = 0;
};

struct ExportedLoadFigures {
  std::string name;
  double max_displacement_mm = 0, max_skin_stress_mpa = 0, max_strut_stress_mpa = 0;
  std::optional<double> buckling_factor;
};

struct ExportedRow {
  std::string figure, better;
  std::optional<double> skin_frame, hollow;
};

struct ExportedVerification {
  bool verified = false;         // by its label
  bool figures_without = false;  // not verified, and yet figures stand there
  double max_displacement_mm = 0, max_stress_mpa = 0, balance_force = 0, balance_moment = 0;
  std::optional<double> strength_mpa, safety_factor, buckling_factor, pinch_mean_mm, pinch_max_mm,
      hollow_thickness_mm, hollow_max_displacement_mm;
  std::vector<ExportedLoadFigures> loads;
  std::vector<ExportedRow> rows;
  std::vector<ExportedRow> of_designs;  // the same rows from the designs' own figures; `better` is empty
  std::vector<ExportedPinchSite> pinch_sites;
  std::optional<ExportedPinch> pinch;  // of pinch.ply
  std::string verdict;
  std::vector<ExportedDeformation> deformations;
};

// Throws where a field is absent or of another type.
ExportedVerification parse_verification(const nlohmann::json& item);

// Errors: kIo and kInvalidInput, naming the file.
Result<ExportedDeformation> read_deformation(const std::filesystem::path& path);
Result<ExportedPinch> read_pinch(const std::filesystem::path& path);

}  // namespace skinframe::check
