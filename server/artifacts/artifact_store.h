// SPDX-License-Identifier: Apache-2.0
// Files named by the SHA-256 of their content.
//
//   DIR/complete/ab/abcdef...   whole, hashed and durable; never written again
//   DIR/partial/abcdef...       an upload under way or interrupted; continued from its end
//
// Guarantees: a name under complete/ appears only by a rename after its content was hashed and synced, so
// what is there after a power cut is whole. One upload of a content at a time, also among servers that share
// the folder (by a lock on the partial file: the file system must have working locks). A partial file that a
// power cut damaged costs a repetition (its hash is wrong, nothing is kept), never a wrong artifact.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "absl/status/statusor.h"
#include "server/artifacts/file.h"

namespace skinframe::server {

struct ArtifactLimits {
  std::int64_t largest_bytes = std::int64_t{2} << 30;
  std::int64_t largest_chunk_bytes = std::int64_t{1} << 20;
};

struct ArtifactFacts {
  bool complete = false;
  std::int64_t size_bytes = 0;     // of the complete artifact
  std::int64_t resume_offset = 0;  // of an interrupted upload
};

class Upload;

class ArtifactStore {
 public:
  static absl::StatusOr<std::unique_ptr<ArtifactStore>> open(const std::filesystem::path& folder,
                                                             const ArtifactLimits& limits);

  // Asking for a complete artifact counts as using it: see unused_since. INVALID_ARGUMENT: not a SHA-256.
  absl::StatusOr<ArtifactFacts> stat(std::string_view sha256) const;

  // Begins or continues. Null: the artifact is complete already. INVALID_ARGUMENT: name or size. ABORTED:
  // another upload of it is under way. FAILED_PRECONDITION: offset is neither 0 nor the end of the kept part.
  absl::StatusOr<std::unique_ptr<Upload>> upload(const std::string& sha256, std::int64_t size_bytes,
                                                 std::int64_t offset);

  // NOT_FOUND: not complete.
  absl::StatusOr<File> read(std::string_view sha256) const;

  // Complete artifacts that were neither written nor asked for since then.
  absl::StatusOr<std::vector<std::string>> unused_since(std::chrono::system_clock::time_point time) const;

  // Removes the artifact unless it was used since then: it is taken aside first and looked at again, so that
  // one that somebody asks for at this moment is put back. False: it was used, or is gone.
  absl::StatusOr<bool> remove_unused(const std::string& sha256, std::chrono::system_clock::time_point since);

  // Removes kept parts that nobody writes and nobody has written since then; how many.
  absl::StatusOr<int> remove_abandoned_parts(std::chrono::system_clock::time_point since);

  // Bytes of all complete artifacts: counted at most once a minute, and in between what was uploaded here is
  // added. So uploads by other servers on the folder, and removals, are seen a minute late.
  absl::StatusOr<std::int64_t> bytes_used();

  // Room on the disk for whoever runs the server.
  absl::StatusOr<std::int64_t> bytes_free() const;

  const ArtifactLimits& limits() const { return limits_; }

 private:
  friend class Upload;
  ArtifactStore(std::filesystem::path folder, const ArtifactLimits& limits);
  std::filesystem::path complete_path(std::string_view sha256) const;
  std::filesystem::path partial_path(std::string_view sha256) const;
  void release(const std::string& sha256);
  void count_upload(std::int64_t size_bytes);

  const std::filesystem::path folder_;
  const ArtifactLimits limits_;
  std::mutex mutex_;
  std::unordered_set<std::string> uploading_;
  std::mutex usage_mutex_;  // guards what follows
  std::int64_t bytes_used_ = 0;
  std::chrono::steady_clock::time_point counted_{};  // never yet
};

// 64 lower-case hexadecimal digits.
bool is_sha256(std::string_view text);

}  // namespace skinframe::server
