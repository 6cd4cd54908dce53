// SPDX-License-Identifier: Apache-2.0
// Messages of the API as JSON, for --json: field names as in the .proto, numbers as numbers (64-bit ones
// too), enums by their word ("SUCCEEDED", "NONE"), times as RFC 3339, durations in seconds. A field that may
// be absent and is, is left out; any other field is there even when it is zero or empty.
#pragma once

#include <google/protobuf/message.h>

#include <nlohmann/json.hpp>
#include <string>

namespace skinframe::client {

nlohmann::ordered_json to_json(const google::protobuf::Message& message);
std::string to_text(const nlohmann::ordered_json& json, int indent = 2);  // invalid UTF-8 is replaced

void print_json(const nlohmann::ordered_json& json);  // on stdout

}  // namespace skinframe::client
