// SPDX-License-Identifier: Apache-2.0
// The embedded store: one SQLite file, one writing thread, any number of readers.
#pragma once

#include <filesystem>
#include <memory>

#include "absl/status/statusor.h"
#include "server/store/job_store.h"

namespace skinframe::server {

// Opens or makes the file, and migrates it. listener may be null; else it outlives the store. Only one
// process at a time may have the file open: the caller holds a lock on its folder.
absl::StatusOr<std::unique_ptr<JobStore>> open_sqlite_store(const std::filesystem::path& file,
                                                            CommitListener* listener);

}  // namespace skinframe::server
