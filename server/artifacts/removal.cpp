// SPDX-License-Identifier: Apache-2.0
// How artifacts go. The order of steps is what keeps one that is still wanted: see remove_unused in the
// header.
#include <system_error>

#include "server/artifacts/artifact_store.h"

namespace skinframe::server {
namespace {

using TimePoint = std::chrono::system_clock::time_point;

// The regular files below a folder, at most one level deeper.
template <class Visit>
absl::Status visit_files(const std::filesystem::path& folder, Visit visit) {
  std::error_code error;
  for (auto at = std::filesystem::recursive_directory_iterator(folder, error);
       !error && at != std::filesystem::recursive_directory_iterator(); at.increment(error)) {
    std::error_code gone;  // another server may remove it while we look
    if (!at->is_regular_file(gone)) continue;
    if (absl::Status status = visit(at->path()); !status.ok()) return status;
  }
  return error ? errno_status(error.value(), folder, "list") : absl::OkStatus();
}

bool unused(const std::filesystem::path& file, TimePoint since) {
  const auto used = used_at(file);
  return used.ok() && *used < since;
}

}  // namespace

absl::StatusOr<std::vector<std::string>> ArtifactStore::unused_since(TimePoint time) const {
  std::vector<std::string> found;
  absl::Status status = visit_files(folder_ / "complete", [&](const std::filesystem::path& file) {
    if (is_sha256(file.filename().string()) && unused(file, time)) found.push_back(file.filename().string());
    return absl::OkStatus();
  });
  if (!status.ok()) return status;
  return found;
}

absl::StatusOr<bool> ArtifactStore::remove_unused(const std::string& sha256, TimePoint since) {
  if (!is_sha256(sha256)) return absl::InvalidArgumentError("not a SHA-256");
  const std::filesystem::path place = complete_path(sha256);
  if (!unused(place, since)) return false;
  const std::filesystem::path aside = place.string() + ".removing";
  std::error_code error;
  std::filesystem::rename(place, aside, error);
  if (error == std::errc::no_such_file_or_directory) return false;
  if (error) return errno_status(error.value(), place, "take aside");
  if (!unused(aside, since)) {  // asked for between the look and the rename
    std::filesystem::rename(aside, place, error);
    return error ? absl::StatusOr<bool>(errno_status(error.value(), aside, "put back")) : false;
  }
  std::filesystem::remove(aside, error);
  return error ? absl::StatusOr<bool>(errno_status(error.value(), aside, "remove")) : true;
}

absl::StatusOr<int> ArtifactStore::remove_abandoned_parts(TimePoint since) {
  int removed = 0;
  absl::Status status =
      visit_files(folder_ / "partial", [&](const std::filesystem::path& file) -> absl::Status {
        if (!unused(file, since)) return absl::OkStatus();
        auto part = File::open_to_write(file);
        if (!part.ok()) return part.status();
        if (absl::Status locked = part->lock(); !locked.ok())
          return absl::IsAborted(locked) ? absl::OkStatus() : locked;  // somebody goes on with it
        std::error_code error;
        std::filesystem::remove(file, error);
        if (error) return errno_status(error.value(), file, "remove");
        ++removed;
        return absl::OkStatus();
      });
  if (!status.ok()) return status;
  return removed;
}

}  // namespace skinframe::server
