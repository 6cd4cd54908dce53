// SPDX-License-Identifier: GPL-3.0-or-later
// The frame problem file (JSON) and its result: the optimiser's own door, and the form of frame.json that
// jobs export. A frame.json is a valid problem file: optimising it again is the simplest check of it.
//
//   {"mechanics": "paper|axial", "material": {"tensile_modulus_mpa", "shear_modulus_mpa",
//   "tensile_strength_mpa",
//    "shear_strength_mpa", "slenderness", "density_g_cm3"}, "nodes": [[x,y,z]...],
//    "struts": [{"a":0,"b":1,"skin":false,"min_radius_mm":..,"max_radius_mm":..}...],
//    "fixed": [{"node":0,"axes":"xyz"}...],
//    "load_cases": [{"name":"..","gravity":true,"forces":[{"node":5,"force_n":[0,0,-20]}]}],
//    "displacement_limit_mm": 0.05 or null, "free_nodes": [..], "stages":
//    ["size","relaxed","topology","geometry"]}
//
// Optional beyond that: "skin_weight_n" (one a node), "skin_mass": {"weight_n","centroid_mm"},
// "balance_half_planes": [{"normal":[x,y],"offset_mm"}], "skin_triangles": [[i,j,k]...], "order":
// "paper|tight". Null or absent strengths, slenderness and limit are off; absent gravity is on, absent stages
// are all of them, absent skin is false. "size" is always among the stages. Fields that are not listed are
// ignored (results ride along).
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "worker/mechanics/frame_problem.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/run/result.h"

namespace skinframe {

inline constexpr std::uintmax_t kMaxProblemFileBytes = std::uintmax_t{256} << 20;
inline constexpr std::size_t kMaxProblemNodes = 1'000'000;
inline constexpr std::size_t kMaxProblemStruts = 8'000'000;
inline constexpr std::size_t kMaxProblemLoadCases = 1'000;
inline constexpr std::size_t kMaxProblemHalfPlanes = 10'000;
// Half planes times (6 nodes + struts): each is a dense row of the optimiser's system.
inline constexpr std::size_t kMaxProblemBalanceEntries = 50'000'000;
inline constexpr std::size_t kMaxProblemForces = 10'000'000;  // load cases times nodes
// Of the JSON, before a tree is made of it: a value takes up to a hundred bytes for two or three of the file.
inline constexpr std::size_t kMaxProblemValues = 30'000'000;
inline constexpr int kMaxProblemDepth = 16;

struct ProblemFile {
  FrameProblem problem;
  OptimizeOptions options;  // stages and order; the rest at its defaults
};

// Errors name the field and its index: "struts[3].a: 900 is not a node (0..511)".
Result<ProblemFile> parse_problem(const nlohmann::json& document);
// Errors call the file by `name`, its path by default: a job's file lies under another one.
Result<ProblemFile> read_problem(const std::filesystem::path& path, const std::string& name);
Result<ProblemFile> read_problem(const std::filesystem::path& path);

// The problem as a problem file, with "radius_mm" on each strut and, where given, "displacements_mm" on each
// load case. Either may be empty. parse_problem(to_json(p, {}, {})) gives p back.
nlohmann::json to_json(const FrameProblem& problem, const std::vector<double>& radii_mm,
                       const std::vector<std::vector<Eigen::Vector3d>>& displacements_mm);

}  // namespace skinframe
