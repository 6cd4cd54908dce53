// SPDX-License-Identifier: GPL-3.0-or-later
// One call of optimize_frame: its options, its run context, and what its stages add up.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "worker/optimize/interior_point.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/optimize/scaled_program.h"
#include "worker/run/run_context.h"

namespace skinframe {

// What the programs of a session cost together.
struct SolverEffort {
  int iterations = 0;
  int factorisations = 0;
  double seconds = 0;  // within the interior point
};

struct ProgramOutcome {
  InteriorPointEnd end = InteriorPointEnd::kStuck;
  std::vector<double> areas_mm2;
  NodeVectors positions_mm;
  double elastic = 0;
  double kkt_error = 0;
  WarmStart warm;  // for the next program of a near frame; empty unless converged to a least volume

  bool converged() const { return end == InteriorPointEnd::kOptimal || end == InteriorPointEnd::kAcceptable; }
};

// All that one program leaves to the next within a session.
struct SessionState {
  SolverEffort effort;
  WarmStart offered, latest;
  std::optional<double> most_mm3;
};

class Session {
 public:
  Session(const OptimizeOptions& options, RunContext& context)
      : options_(options), context_(context), team_(std::make_shared<ThreadTeam>(context.threads)) {}

  const OptimizeOptions& options() const { return options_; }
  bool cancelled() const { return context_.cancelled(); }
  const SolverEffort& effort() const { return state_.effort; }
  void enter(Stage stage) { stage_ = stage, stage_iteration_ = 0; }

  // The duals that programs of least volume start from, as long as the count of nodes fits; empty: none.
  void offer(WarmStart warm) { state_.offered = std::move(warm); }
  // Programs of least volume stop as soon as their optimum is sure to lie above this; none: they run on.
  void give_up_above(std::optional<double> volume_mm3) { state_.most_mm3 = volume_mm3; }
  // Of the last program of least volume that converged.
  const WarmStart& latest() const { return state_.latest; }

  // For checkpoints.
  SessionState& state() { return state_; }

  // Builds the program, runs the interior point, reports progress at each of its iterations. `good_enough`:
  // see there.
  ProgramOutcome solve(const FrameProblem& problem, ProgramRequest request,
                       const std::vector<double>& start_mm2,
                       std::function<bool(const ProgramVector&, const KktError&)> good_enough = {});

 private:
  const OptimizeOptions& options_;
  RunContext& context_;
  std::shared_ptr<ThreadTeam> team_;
  Stage stage_ = Stage::kSize;
  int stage_iteration_ = 0;
  SessionState state_;
};

}  // namespace skinframe
