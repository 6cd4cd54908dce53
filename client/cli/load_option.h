// SPDX-License-Identifier: Apache-2.0
// Options of a job that have a grammar of their own. Strict: what is not exactly of the form is refused with
// a sentence that shows the form.
#pragma once

#include <google/protobuf/duration.pb.h>

#include <string>
#include <utility>

#include "client/call/result.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::client {

// --load NAME:WHERE:FX,FY,FZ[:RADIUS], in N and mm; WHERE = top, bottom, left, right, front, back or x,y,z.
Result<v1::Load> parse_load(const std::string& text);

// --label KEY=VALUE
Result<std::pair<std::string, std::string>> parse_label(const std::string& text);

// --deadline: 90, 90s, 15m or 2h; at least a second, at most 365 days.
Result<google::protobuf::Duration> parse_deadline(const std::string& text);

}  // namespace skinframe::client
