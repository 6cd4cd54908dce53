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

  std::vector<double> areas_mm2(const ProgramVector& point) const;
  NodeVectors positions_mm(const ProgramVector& point) const;
  double volume_mm3(double scaled_volume) const { return scaled_volume * scale_.area_mm2 * scale_.length_mm; }
  void restore_equilibrium(ProgramVector& point) const;

 private:
  void add_cases();
  void add_strain_limits();
  void add_balance();
  void add_geometry();

  const FrameProblem& problem_;
  ProgramRequest request_;
  ProgramScale scale_;
  FrameProgram program_;
  ProgramVector start_;
};

}  // namespace skinframe
