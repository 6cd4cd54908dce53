// SPDX-License-Identifier: Apache-2.0
// The programs that are installed beside this one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/call/result.h"

namespace skinframe::client {

// skinframe-worker: the file that SKINFRAME_WORKER names, or the one in this program's folder.
Result<std::filesystem::path> worker_program();
// skinframe-server, in this program's folder.
Result<std::filesystem::path> server_program();

// This process becomes `skinframe-worker WORDS...`; returns only when that does not work.
Failure become_worker(const std::vector<std::string>& words);

}  // namespace skinframe::client
