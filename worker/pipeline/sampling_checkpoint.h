// SPDX-License-Identifier: GPL-3.0-or-later
// The sampled frame and what is said about it, kept once stress map and sampling are done, so that a later
// attempt of the job need not make them again.
#pragma once

#include <functional>
#include <string>

#include "worker/frame/sample_frame.h"
#include "worker/report/report.h"
#include "worker/run/checkpoints.h"
#include "worker/run/run_context.h"

namespace skinframe {

// From the checkpoint under this key, with sampling, warnings and seconds told in the report; else by
// `sample`, whose outcome is kept.
Result<SampledFrame> sample_or_go_on(const std::string& key,
                                     const std::function<Result<SampledFrame>()>& sample,
                                     PrinterReport* report, Checkpoints* checkpoints);

}  // namespace skinframe
