// SPDX-License-Identifier: Apache-2.0
// The texts of profiles/*.json, put into the program when it is built: a server needs no file to start.
#pragma once

#include <string_view>
#include <vector>

namespace skinframe::server {

struct BuiltInProfile {
  std::string_view name;  // "profiles/pla.json"
  std::string_view text;
};
const std::vector<BuiltInProfile>& built_in_profiles();

}  // namespace skinframe::server
