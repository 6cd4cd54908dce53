// SPDX-License-Identifier: Apache-2.0
// The API's enums, times and foreign texts as people read them.
#pragma once

#include <google/protobuf/timestamp.pb.h>

#include <optional>
#include <string>
#include <string_view>

#include "skinframe/v1/catalog.pb.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::client {

std::string state_word(v1::JobState state);                          // "SUCCEEDED"
std::string reason_word(v1::Reason reason);                          // "INFEASIBLE"; "NONE" for no reason
std::string process_word(v1::PrintProcess process);                  // "powder"
std::optional<v1::JobState> state_from_word(std::string_view word);  // "succeeded", "SUCCEEDED"

// UTC, "2026-11-22T04:31:07.120Z"; "-" for none.
std::string time_text(const google::protobuf::Timestamp& time);

// A text that somebody else wrote, safe on a terminal and in one line: control characters become spaces.
std::string one_line(std::string_view text);

}  // namespace skinframe::client
