// SPDX-License-Identifier: Apache-2.0
// The server's folder, held by one server at a time.
#pragma once

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"

namespace skinframe::server {

class DataFolder {
 public:
  // Makes the folder when absent and locks it until the value goes, or the process ends in whatever way.
  // FAILED_PRECONDITION: another server has it. PERMISSION_DENIED: not ours to write.
  static absl::StatusOr<DataFolder> lock(const std::filesystem::path& folder);
  ~DataFolder();
  DataFolder(DataFolder&& other) noexcept;
  DataFolder& operator=(DataFolder&&) = delete;

  std::filesystem::path store_file() const { return folder_ / "jobs.sqlite"; }
  std::filesystem::path artifacts() const { return folder_ / "artifacts"; }

 private:
  DataFolder(std::filesystem::path folder, int lock) : folder_(std::move(folder)), lock_(lock) {}

  std::filesystem::path folder_;
  int lock_;
};

// Writes the file whole or not at all: a reader never sees half of it.
absl::Status write_file_at_once(const std::filesystem::path& file, const std::string& text);

absl::StatusOr<std::string> read_whole_file(const std::filesystem::path& file);

}  // namespace skinframe::server
