// SPDX-License-Identifier: Apache-2.0
#include "server/artifacts/upload.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

namespace skinframe::server {
namespace {

constexpr std::size_t kRereadBytes = std::size_t{1} << 20;

std::string hex_digest(EVP_MD_CTX* digest) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int size = 0;
  if (EVP_DigestFinal_ex(digest, bytes.data(), &size) != 1) return {};  // equals no name
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", bytes[i]);
  return hex;
}

}  // namespace

Upload::Upload(ArtifactStore& store, std::string sha256, std::int64_t size_bytes)
    : store_(store), sha256_(std::move(sha256)), size_bytes_(size_bytes), digest_(EVP_MD_CTX_new()) {}

Upload::~Upload() { store_.release(sha256_); }

absl::Status Upload::start(std::int64_t offset) {
  if (digest_ == nullptr || EVP_DigestInit_ex(digest_.get(), EVP_sha256(), nullptr) != 1) {
    return absl::InternalError("OpenSSL cannot compute a SHA-256");
  }
  auto file = File::open_to_write(store_.partial_path(sha256_));
  if (!file.ok()) return file.status();
  file_ = *std::move(file);
  // Other servers may share the folder: nobody else may write here, nor turn what we write into a finished
  // file.
  if (absl::Status status = file_.lock(); !status.ok()) return status;
  const auto kept = file_.size();
  if (!kept.ok()) return kept.status();
  if (offset == 0) return file_.truncate(0);
  if (offset != *kept || offset > size_bytes_) {
    return absl::FailedPreconditionError(
        fmt::format("offset is {}, but {} bytes are kept; Stat tells where to resume", offset, *kept));
  }
  written_ = offset;
  return hash_kept_part();
}

absl::Status Upload::hash_kept_part() {
  for (std::int64_t at = 0; at < written_;) {
    const auto want = static_cast<std::size_t>(std::min<std::int64_t>(written_ - at, kRereadBytes));
    const auto bytes = file_.read_at(at, want);
    if (!bytes.ok()) return bytes.status();
    if (bytes->size() != want) return absl::InternalError("the kept part became shorter while it was read");
    EVP_DigestUpdate(digest_.get(), bytes->data(), bytes->size());
    at += static_cast<std::int64_t>(want);
  }
  return absl::OkStatus();
}

absl::Status Upload::append(std::string_view chunk) {
  const auto size = static_cast<std::int64_t>(chunk.size());
  if (size > store_.limits().largest_chunk_bytes) {
    return absl::InvalidArgumentError(fmt::format("a chunk of {} bytes is over the limit of {}", size,
                                                  store_.limits().largest_chunk_bytes));
  }
  if (written_ + size > size_bytes_) {
    return absl::InvalidArgumentError(
        fmt::format("more than the {} bytes that the header says", size_bytes_));
  }
  if (absl::Status status = file_.write_at(written_, chunk); !status.ok()) return status;
  EVP_DigestUpdate(digest_.get(), chunk.data(), chunk.size());
  written_ += size;
  return absl::OkStatus();
}

absl::Status Upload::finish() {
  if (written_ != size_bytes_) {
    return absl::InvalidArgumentError(fmt::format(
        "the stream ended after {} of {} bytes, which are kept; resume there", written_, size_bytes_));
  }
  if (const std::string actual = hex_digest(digest_.get()); actual != sha256_) {
    discard();
    return absl::DataLossError(
        fmt::format("the content's SHA-256 is {}, not {}; nothing is kept", actual, sha256_));
  }
  if (absl::Status status = file_.sync(); !status.ok()) return status;
  const auto place = store_.complete_path(sha256_);
  std::error_code error;
  if (std::filesystem::create_directory(place.parent_path(), error)) {
    if (absl::Status status = sync_folder(place.parent_path().parent_path()); !status.ok()) return status;
  }
  if (!error) std::filesystem::rename(store_.partial_path(sha256_), place, error);
  if (error) return errno_status(error.value(), place, "make");
  store_.count_upload(size_bytes_);
  return sync_folder(place.parent_path());
}

void Upload::discard() {
  std::error_code ignored;  // a left-over is found wrong again by the next upload
  std::filesystem::remove(store_.partial_path(sha256_), ignored);
}

}  // namespace skinframe::server
