// SPDX-License-Identifier: Apache-2.0
#include "server/artifacts/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace skinframe::server {

absl::Status errno_status(int error, const std::filesystem::path& file, std::string_view doing) {
  const std::string message = fmt::format("cannot {} {}: {}", doing, file.string(), std::strerror(error));
  switch (error) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return absl::ResourceExhaustedError("no room on the server's disk (" + message + ")");
    case ENOENT:
      return absl::NotFoundError(message);
    default:
      return absl::InternalError(message);
  }
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

File::File(File&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

File& File::operator=(File&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(path_, other.path_);
  return *this;
}

absl::StatusOr<File> File::open_to_read(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno_status(errno, file, "open");
  return File(descriptor, file);
}

absl::StatusOr<File> File::open_to_write(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
  if (descriptor < 0) return errno_status(errno, file, "open");
  return File(descriptor, file);
}

absl::StatusOr<std::int64_t> File::size() const {
  struct stat facts {};
  if (::fstat(descriptor_, &facts) != 0) return errno_status(errno, path_, "look at");
  return static_cast<std::int64_t>(facts.st_size);
}

absl::Status File::lock() {
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK)
      return absl::AbortedError(fmt::format("another server writes {}", path_.filename().string()));
    return errno_status(errno, path_, "lock");
  }
  struct stat ours {};
  struct stat named {};
  if (::fstat(descriptor_, &ours) != 0) return errno_status(errno, path_, "look at");
  if (::stat(path_.c_str(), &named) != 0 || named.st_ino != ours.st_ino || named.st_dev != ours.st_dev)
    return absl::AbortedError(fmt::format("another server has finished {}", path_.filename().string()));
  return absl::OkStatus();
}

absl::Status File::truncate(std::int64_t size) {
  if (::ftruncate(descriptor_, size) != 0) return errno_status(errno, path_, "cut");
  return absl::OkStatus();
}

absl::Status File::write_at(std::int64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), offset);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno_status(errno, path_, "write");
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += written;
  }
  return absl::OkStatus();
}

absl::StatusOr<std::string> File::read_at(std::int64_t offset, std::size_t size) const {
  std::string bytes(size, '\0');
  std::size_t filled = 0;
  while (filled < size) {
    const ssize_t got = ::pread(descriptor_, bytes.data() + filled, size - filled,
                                offset + static_cast<std::int64_t>(filled));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno_status(errno, path_, "read");
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

absl::Status File::sync() {
  if (::fsync(descriptor_) != 0) return errno_status(errno, path_, "make durable");
  return absl::OkStatus();
}

absl::StatusOr<std::chrono::system_clock::time_point> used_at(const std::filesystem::path& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) return errno_status(errno, file, "look at");
  const auto since_1970 =
      std::chrono::seconds(facts.st_mtim.tv_sec) + std::chrono::nanoseconds(facts.st_mtim.tv_nsec);
  return std::chrono::system_clock::time_point(
      std::chrono::duration_cast<std::chrono::system_clock::duration>(since_1970));
}

absl::Status touch(const std::filesystem::path& file) {
  if (::utimensat(AT_FDCWD, file.c_str(), nullptr, 0) != 0) return errno_status(errno, file, "touch");
  return absl::OkStatus();
}

absl::Status sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno_status(errno, folder, "open");
  const int result = ::fsync(descriptor);
  const int error = errno;
  ::close(descriptor);
  return result == 0 ? absl::OkStatus() : errno_status(error, folder, "make durable");
}

}  // namespace skinframe::server
