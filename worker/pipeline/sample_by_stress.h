// SPDX-License-Identifier: GPL-3.0-or-later
// The initial frame of one printer: a stress map of the solid under the job's loads, and nodes whose density
// follows it. Where no map can be made, curvature alone leads, and a warning says why. Drain holes, where the
// printer's profile has a rule for them, are placed before.
#pragma once

#include "worker/frame/sample_frame.h"
#include "worker/pipeline/laps.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/pipeline/request.h"
#include "worker/report/report.h"
#include "worker/run/run_context.h"

namespace skinframe {

// What the job asks of its frame, but for the stress map.
FrameOptions frame_options(const PrinterRequest& request, const JobRequest& job);

// density: "stress+curvature" or "curvature".
SamplingFacts sampling_facts(const SampledFrame& sampled, const std::string& density);

// Fills the report's sampling facts, its warnings, and the seconds of "stress" and "sample".
Result<SampledFrame> sample_by_stress(const PreparedSolid& prepared, const Skin& skin,
                                      const PrinterRequest& request, const JobRequest& job, Laps& laps,
                                      PrinterReport* report, RunContext& context);

}  // namespace skinframe
