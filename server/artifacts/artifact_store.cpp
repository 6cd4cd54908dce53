// SPDX-License-Identifier: Apache-2.0
#include "server/artifacts/artifact_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "server/artifacts/upload.h"

namespace skinframe::server {
namespace {

absl::Status not_a_sha256() {
  return absl::InvalidArgumentError("sha256 must be 64 lower-case hexadecimal digits");
}

// The size of a regular file; -1 when there is none.
std::int64_t size_or_absent(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? -1 : static_cast<std::int64_t>(size);
}

}  // namespace

bool is_sha256(std::string_view text) {
  return text.size() == 64 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

ArtifactStore::ArtifactStore(std::filesystem::path folder, const ArtifactLimits& limits)
    : folder_(std::move(folder)), limits_(limits) {}

absl::StatusOr<std::unique_ptr<ArtifactStore>> ArtifactStore::open(const std::filesystem::path& folder,
                                                                   const ArtifactLimits& limits) {
  for (const char* part : {"complete", "partial"}) {
    std::error_code error;
    std::filesystem::create_directories(folder / part, error);
    if (error) return errno_status(error.value(), folder / part, "make folder");
  }
  if (absl::Status status = sync_folder(folder); !status.ok()) return status;
  return std::unique_ptr<ArtifactStore>(new ArtifactStore(folder, limits));
}

std::filesystem::path ArtifactStore::complete_path(std::string_view sha256) const {
  return folder_ / "complete" / sha256.substr(0, 2) / sha256;
}

std::filesystem::path ArtifactStore::partial_path(std::string_view sha256) const {
  return folder_ / "partial" / sha256;
}

absl::StatusOr<ArtifactFacts> ArtifactStore::stat(std::string_view sha256) const {
  if (!is_sha256(sha256)) return not_a_sha256();
  ArtifactFacts facts;
  if (const std::int64_t size = size_or_absent(complete_path(sha256)); size >= 0) {
    facts.complete = true;
    facts.size_bytes = size;
    if (absl::Status status = touch(complete_path(sha256)); !status.ok()) return status;
  } else {
    facts.resume_offset = std::max<std::int64_t>(0, size_or_absent(partial_path(sha256)));
  }
  return facts;
}

absl::StatusOr<std::unique_ptr<Upload>> ArtifactStore::upload(const std::string& sha256,
                                                              std::int64_t size_bytes, std::int64_t offset) {
  if (!is_sha256(sha256)) return not_a_sha256();
  if (size_bytes <= 0 || size_bytes > limits_.largest_bytes) {
    return absl::InvalidArgumentError(
        fmt::format("size_bytes is {}, must be within 1 .. {}", size_bytes, limits_.largest_bytes));
  }
  {
    const std::lock_guard lock(mutex_);
    if (!uploading_.insert(sha256).second) {
      return absl::AbortedError(fmt::format("another upload of {} is under way", sha256));
    }
  }
  std::unique_ptr<Upload> upload(new Upload(*this, sha256, size_bytes));  // releases the name when it goes
  if (const std::int64_t size = size_or_absent(complete_path(sha256)); size >= 0) {
    if (size == size_bytes) {
      if (absl::Status status = touch(complete_path(sha256)); !status.ok()) return status;
      return nullptr;
    }
    return absl::InvalidArgumentError(
        fmt::format("size_bytes is {}, but the artifact of that name has {} bytes", size_bytes, size));
  }
  if (absl::Status status = upload->start(offset); !status.ok()) return status;
  return upload;
}

absl::StatusOr<File> ArtifactStore::read(std::string_view sha256) const {
  if (!is_sha256(sha256)) return absl::NotFoundError(fmt::format("no artifact \"{}\"", sha256));
  auto file = File::open_to_read(complete_path(sha256));
  if (absl::IsNotFound(file.status())) return absl::NotFoundError(fmt::format("no artifact {}", sha256));
  return file;
}

void ArtifactStore::release(const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  uploading_.erase(sha256);
}

}  // namespace skinframe::server
