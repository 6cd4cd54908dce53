// SPDX-License-Identifier: GPL-3.0-or-later
// From a frame problem in mm and N to a frame program in nondimensional numbers of order one, and back.
//
//   unit of    length        mean strut length
//              area          mean area of the start, weighed by length
//              displacement  the limit (6), or the start's largest displacement where there is none
//              modulus       gamma
//              force         gamma * area * displacement / length
//
// so that tolerances mean the same in any system of units.
#pragma once

#include <optional>
#include <vector>

#include "worker/frame/half_space.h"
#include "worker/mechanics/equilibrium.h"
#include "worker/mechanics/frame_problem.h"
#include "worker/optimize/frame_program.h"
#include "worker/optimize/iterate.h"
#include "worker/optimize/warm_start.h"

namespace skinframe {

struct ProgramScale {
  double length_mm = 1, area_mm2 = 1, displacement_mm = 1, force_n = 1;
};

// What a stage asks for beyond the problem itself.
struct ProgramRequest {
  std::vector<int> cases;                      // load cases that take part
  std::vector<double> lower_mm2, upper_mm2;    // one a strut
  double limit_factor = 1;                     // multiplies the limits of (2), (3) and (6)
  ElasticScope elastic = ElasticScope::kNone;  // minimise t, and not the volume, when not kNone
  std::optional<double> volume_cap_mm3;
  std::vector<double> area_weights;   // minimise sum w A, and not the volume, when not empty; of order one
  NodeRegions regions;                // nodes with a list move; empty: none does
  std::vector<double> min_length_mm;  // one a strut, where nodes move
  double initial_barrier = 0.1;       // less where the start is near the optimum
  double tolerance_factor = 1;        // on OptimizeOptions::kkt_tolerance
  std::optional<int> max_iterations;  // beneath the options' own
  WarmStart warm;                     // duals to start from; empty: none
};

// Lower and upper areas of all struts as area_bounds leaves them.
void set_size_bounds(const FrameProblem& problem, ProgramRequest& request);

class ScaledProgram {
 public:
  // `start_mm2` sets the scale and is where start() stands.
  ScaledProgram(const FrameProblem& problem, ProgramRequest request, const std::vector<double>& start_mm2);

  const FrameProgram& program() const { return program_; }
  ProgramVector start() const {
    return start_;
  }  // areas as given, displacements in equilibrium, multipliers zero

  // For InteriorPointOptions::start_duals: what the request's warm start knows; empty when that is empty.
  const Eigen::VectorXd& start_duals() const { return start_duals_; }
  WarmStart warm_start(const ProgramVector& point, const Eigen::VectorXd& duals) const;

  std::vector<double> areas_mm2(const ProgramVector& point) const;
  NodeVectors positions_mm(const ProgramVector& point) const;
  double volume_mm3(double scaled_volume) const { return scaled_volume * scale_.area_mm2 * scale_.length_mm; }
  // How far the optimum may lie below the volume of a point of this error: the sum of duals times slacks, at
  // most.
  double gap(const KktError& error) const { return error.complementarity * InequalityLayout(program_).count; }
  void restore_equilibrium(ProgramVector& point) const;

 private:
  void add_cases();
  void add_strain_limits();
  void add_balance();
  void add_geometry();
  void add_warm_start();
  double multiplier_unit() const { return scale_.area_mm2 * scale_.length_mm / scale_.force_n; }

  const FrameProblem& problem_;
  ProgramRequest request_;
  ProgramScale scale_;
  FrameProgram program_;
  ProgramVector start_;
  Eigen::VectorXd start_duals_;
};

}  // namespace skinframe
