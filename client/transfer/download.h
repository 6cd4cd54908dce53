// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "client/call/connect.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::client {

// Writes the job's result files below folder, which is made when missing. Returns their paths.
// Each file appears under its name only when it is whole and has the hash that the job names; what was there
// under that name is replaced. An interrupted stream goes on where it stopped. kInternal: a path that leads
// out of the folder (nothing is written then), a content with another hash. kLocal: the folder cannot be
// written. kNotFound, kUnreachable, kInterrupted.
Result<std::vector<std::filesystem::path>> download_results(const Connection& connection, const v1::Job& job,
                                                            const std::filesystem::path& folder);

}  // namespace skinframe::client
