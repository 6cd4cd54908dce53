// SPDX-License-Identifier: Apache-2.0
// `skinframe doctor`: looks at everything between this program and a finished job, and says what is wrong
// with it.
#pragma once

#include <string>
#include <vector>

#include "client/cli/verbs.h"
#include "skinframe/v1/server.pb.h"

namespace skinframe::client {

enum class Finding { kWell, kNote, kWrong };

struct Examined {
  Finding finding = Finding::kWell;
  std::string what;  // "clock"
  std::string says;  // one sentence; with kNote and kWrong the remedy too
};

// What the server's answer tells, asked at `asked` and come at `came` by this machine's clock, ms since 1970.
std::vector<Examined> examine(const v1::ServerInfo& info, std::int64_t asked_ms, std::int64_t came_ms);

// 0: all is well, notes included; 7: no server answers, 2: it refuses the caller, 5: something is wrong.
ExitCode doctor(const GlobalArguments& global);

}  // namespace skinframe::client
