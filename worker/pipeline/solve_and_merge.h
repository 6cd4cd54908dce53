// SPDX-License-Identifier: GPL-3.0-or-later
// The optimised frame and the mesh that is printed of it, in rounds: the nominal model counts overlapping
// struts twice, so its centre of gravity is not quite that of the print. Where balance is claimed, what the
// print lacks is asked of the model as well, until the printed mesh itself stands.
#pragma once

#include <optional>

#include "worker/export/open_holes.h"
#include "worker/pipeline/earlier_frame.h"
#include "worker/pipeline/laps.h"
#include "worker/pipeline/pose_problem.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/report/report.h"
#include "worker/run/run_context.h"

namespace skinframe {

inline constexpr int kMaxBalanceRounds = 4;  // beyond the first

// Where the optimiser starts instead of from nothing.
struct ReducedStart {
  const InitialFrame& earlier;
  FrameProblem problem;  // this job's, posed on the earlier job's reduced frame
};

struct SolveSetting {
  const PreparedSolid& prepared;
  const Skin& skin;
  const PrinterProfile& printer;
  const JobOptions& options;
  BalanceState balance;
  Laps& laps;
  std::optional<ReducedStart> start;
  Checkpoints* checkpoints = nullptr;
  std::vector<Opening> openings;  // drain holes to cut
};

// The merged mesh, and the same with its drain holes.
struct MergedPrint {
  PrintableMesh closed;
  std::optional<OpenedMesh> opened;  // none: no holes were asked for
  const TriangleMesh& mesh() const { return opened ? opened->mesh : closed.mesh; }
  double volume_mm3() const { return opened ? opened->volume_mm3 : closed.volume_mm3; }
};

// Fills the report's optimised frame, supports, statistics, termination and reason. No mesh when the job is
// infeasible. `problem` is left as it was solved last: its balance half planes drawn in as the print asked
// for.
Result<std::optional<MergedPrint>> solve_and_merge(const SolveSetting& setting, FrameProblem* problem,
                                                   PrinterReport* report, RunContext& context);

}  // namespace skinframe
