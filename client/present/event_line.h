// SPDX-License-Identifier: Apache-2.0
// One event, one line. Pure: the same event gives the same line in every terminal and whenever it is watched.
#pragma once

#include <string>

#include "skinframe/v1/job.pb.h"

namespace skinframe::client {

// "sinterstation-hiq  size  iteration 3  total 94750 mm3  ratio 11.6 %  884 struts": what is not known is
// left out.
std::string progress_text(const v1::JobProgress& progress);

// "RUNNING (attempt 2)", "FAILED, INFEASIBLE: the head sinks", a progress text, or "sinterstation-hiq:
// SUCCEEDED ...".
std::string event_text(const v1::JobEvent& event);

// With sequence number and time before it: "    17  2026-11-22T04:31:07.120Z  ..."
std::string event_line(const v1::JobEvent& event);

}  // namespace skinframe::client
