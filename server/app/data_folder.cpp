// SPDX-License-Identifier: Apache-2.0
#include "server/app/data_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace skinframe::server {

absl::StatusOr<DataFolder> DataFolder::lock(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return absl::PermissionDeniedError(
        fmt::format("cannot make the data folder {}: {}", folder.string(), error.message()));
  }
  const auto file = folder / "lock";
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
  if (descriptor < 0) {
    return absl::PermissionDeniedError(
        fmt::format("cannot write to the data folder {}: {}", folder.string(), std::strerror(errno)));
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor);
    return absl::FailedPreconditionError(
        fmt::format("another server is using the data folder {}", folder.string()));
  }
  return DataFolder(folder, descriptor);
}

DataFolder::~DataFolder() {
  if (lock_ >= 0) ::close(lock_);
}

DataFolder::DataFolder(DataFolder&& other) noexcept
    : folder_(std::move(other.folder_)), lock_(std::exchange(other.lock_, -1)) {}

absl::Status write_file_at_once(const std::filesystem::path& file, const std::string& text) {
  auto temporary = file;
  temporary += ".new";
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (!out) return absl::PermissionDeniedError(fmt::format("cannot write {}", temporary.string()));
  }
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error)
    return absl::PermissionDeniedError(fmt::format("cannot write {}: {}", file.string(), error.message()));
  return absl::OkStatus();
}

absl::StatusOr<std::string> read_whole_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return absl::NotFoundError(fmt::format("cannot read {}", file.string()));
  return std::string(std::istreambuf_iterator<char>(in), {});
}

}  // namespace skinframe::server
