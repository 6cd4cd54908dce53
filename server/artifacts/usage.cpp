// SPDX-License-Identifier: Apache-2.0
// How much room the artifacts take.
#include <system_error>

#include "server/artifacts/artifact_store.h"

namespace skinframe::server {
namespace {

constexpr std::chrono::seconds kCountIsGoodFor{60};

}  // namespace

absl::StatusOr<std::int64_t> ArtifactStore::bytes_used() {
  const auto now = std::chrono::steady_clock::now();
  const std::lock_guard lock(usage_mutex_);
  const bool known = counted_ != std::chrono::steady_clock::time_point{};
  if (known && now - counted_ < kCountIsGoodFor) return bytes_used_;
  std::int64_t bytes = 0;
  std::error_code error;
  const auto folder = folder_ / "complete";
  for (auto at = std::filesystem::recursive_directory_iterator(folder, error);
       !error && at != std::filesystem::recursive_directory_iterator(); at.increment(error)) {
    std::error_code gone;  // the cleaner may remove it while we look
    if (!at->is_regular_file(gone)) continue;
    const auto size = at->file_size(gone);
    if (!gone) bytes += static_cast<std::int64_t>(size);
  }
  if (error) return errno_status(error.value(), folder, "list");
  bytes_used_ = bytes;
  counted_ = now;
  return bytes_used_;
}

void ArtifactStore::count_upload(std::int64_t size_bytes) {
  const std::lock_guard lock(usage_mutex_);
  bytes_used_ += size_bytes;
}

absl::StatusOr<std::int64_t> ArtifactStore::bytes_free() const {
  std::error_code error;
  const auto space = std::filesystem::space(folder_, error);
  if (error) return errno_status(error.value(), folder_, "look at the room of");
  return static_cast<std::int64_t>(space.available);
}

}  // namespace skinframe::server
