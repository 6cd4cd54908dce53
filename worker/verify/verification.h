// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of a printed result by the valid model, beside the paper's: figures labelled "verified".
// Units: mm, N, MPa, g.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace skinframe {

struct LoadFigures {
  std::string name;
  double max_displacement_mm = 0;  // of the skin
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  // The load's work over its size: how far its point of attack gives way along it. None where only weight
  // acts.
  std::optional<double> load_displacement_mm;
  double skin_stress_mpa = 0;                              // von Mises, the larger of both surfaces
  double strut_stress_mpa = 0;                             // von Mises, extreme fibre
  Eigen::Vector3d stress_at_mm = Eigen::Vector3d::Zero();  // of the larger one
  std::optional<double> buckling_factor;  // first linear one; none: no multiple of the load buckles it
};

struct PinchedSite {
  std::array<Eigen::Vector3d, 2> fingers_mm{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double closing_mm = 0;
};

struct PinchFigures {
  std::vector<PinchedSite> sites;
  double mean_mm = 0, max_mm = 0;  // closing distance
  int worst = -1;                  // of the sites
};

PinchFigures figures_of_sites(std::vector<PinchedSite> sites);

// One design under the job's loads.
struct DesignFigures {
  double weight_g = 0;
  std::vector<LoadFigures> loads;
  std::optional<PinchFigures> pinch;  // none: the object offers no site

  double max_displacement_mm() const;
  double max_stress_mpa() const;
  std::optional<double> buckling_factor() const;  // the least; none where no load has one
};

// Displacements of the skin's mid-surface under one load.
struct Deformation {
  std::string name;
  std::vector<Eigen::Vector3d> displacement_mm;  // one a vertex
};

struct Verification {
  DesignFigures ours;
  std::optional<DesignFigures> skin_alone, hollow, solid;  // skin alone: not where it falls apart
  std::string hollow_missing, solid_missing;               // why, where they are not there
  double hollow_wall_mm = 0;                               // of equal printed mass
  std::optional<double> strength_mpa;
  std::optional<double> safety_factor;           // strength over the largest stress of all loads
  std::optional<double> euler_factor;            // least Euler load over compression of all internal struts
  int euler_strut = -1;                          // of the frame
  double balance_force = 0, balance_moment = 0;  // of reactions against loads, relative
  int levels = 0;                                // divisions of the skin triangulation
  std::size_t nodes = 0, triangles = 0;
  double mesh_error = 0;  // of the loads' work, relative: mesh_error_of
  std::string verdict;    // who wins, in words
  // Of the thread, by stage: mesh (its divisions, each assembled and factorised), pinch sites, skin-frame,
  // skin alone, hollow, solid.
  std::map<std::string, double> cpu_seconds;
  std::vector<Eigen::Vector3d> skin_mm;  // mid-surface
  std::vector<std::array<int, 3>> skin_triangles;
  std::vector<Deformation> deformations;
};

// The rows in which designs are compared: lower is better, but for buckling.
enum class Winner { kSkinFrame, kHollow, kNeither };
struct ComparedRow {
  std::string name;
  std::optional<double> ours, hollow, solid, skin_alone;
  Winner winner = Winner::kNeither;  // of skin-frame and hollow, at equal mass; neither within kEvenShare
};
inline constexpr double kEvenShare = 0.01;
std::vector<ComparedRow> compare(const Verification& verification);
const char* to_string(Winner winner);  // "skin-frame", "hollow", "even"

inline constexpr double kMeshTolerance = 0.05;
// An estimate of the relative error of the last mesh, the largest of all loads; works: one row a mesh, each
// of half the spacing of the one before, two or more. Richardson's: the last change over ratio - 1, where the
// ratio of the last two changes is taken as it is between 2 and 4 (order one to two), and as 2 below and
// where there are two meshes only or the changes differ in sign, so that the last change itself counts.
// Relative to the load's work, or to least_work where that is more: one a load, of what moves so little that
// nobody asks by how much.
double mesh_error_of(const std::vector<std::vector<double>>& works, const std::vector<double>& least_work);
// The estimate against kMeshTolerance, in words: says so where it does not hold.
std::string mesh_words(const Verification& verification);

// In words, of compare(): says so where hollow wins or draws every row.
std::string verdict_of(const Verification& verification);

}  // namespace skinframe
