// SPDX-License-Identifier: Apache-2.0
// A file descriptor as a value, with errors as a status that names the file. What artifacts need of POSIX.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace skinframe::server {

// No room (disk or quota full, file size limit): RESOURCE_EXHAUSTED. Absent: NOT_FOUND. The rest: INTERNAL.
absl::Status errno_status(int error, const std::filesystem::path& file, std::string_view doing);

class File {
 public:
  File() = default;
  ~File();
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  static absl::StatusOr<File> open_to_read(const std::filesystem::path& file);
  static absl::StatusOr<File> open_to_write(
      const std::filesystem::path& file);  // made when absent, kept when there

  absl::StatusOr<std::int64_t> size() const;
  // For this descriptor alone among all processes, until it is closed. ABORTED: another one has it, or the
  // name has meanwhile become another file's.
  absl::Status lock();
  absl::Status truncate(std::int64_t size);
  absl::Status write_at(std::int64_t offset, std::string_view bytes);  // all of them
  // Up to size bytes; fewer only at the end of the file.
  absl::StatusOr<std::string> read_at(std::int64_t offset, std::size_t size) const;
  absl::Status sync();

 private:
  File(int descriptor, std::filesystem::path path) : descriptor_(descriptor), path_(std::move(path)) {}

  int descriptor_ = -1;
  std::filesystem::path path_;
};

// The time of the last write or touch; NOT_FOUND.
absl::StatusOr<std::chrono::system_clock::time_point> used_at(const std::filesystem::path& file);
// Sets that time to now. NOT_FOUND.
absl::Status touch(const std::filesystem::path& file);

// Makes the folder's own entries durable: after a rename into it.
absl::Status sync_folder(const std::filesystem::path& folder);

}  // namespace skinframe::server
