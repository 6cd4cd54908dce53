// SPDX-License-Identifier: GPL-3.0-or-later
// Two parts of a job at once, neither of which needs the other, but whose results are wanted together.
//
// Guarantees:
//  1. Both have ended when this returns. `beside` runs on a second thread where the job has one, else after
//     `here`.
//  2. The first that fails, or throws, stops the other through its context, and its error is returned: not
//     the other's that it was cancelled.
//  3. The job's own cancellation reaches both.
#pragma once

#include <functional>

#include "worker/run/run_context.h"

namespace skinframe {

using JobPart = std::function<Status(const RunContext&)>;

Status side_by_side(const JobPart& here, const JobPart& beside, const RunContext& context);

}  // namespace skinframe
