// SPDX-License-Identifier: Apache-2.0
#include "client/transfer/download.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

#include "client/call/retry.h"
#include "client/transfer/safe_path.h"
#include "proto/transport/sha256.h"
#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::client {
namespace {

namespace fs = std::filesystem;

constexpr int kAttemptsWithoutProgress = 6;
constexpr std::chrono::minutes kStreamDeadline{30};

Failure cannot_write(const fs::path& path, const std::string& why) {
  return {FailureKind::kLocal, fmt::format("{}: cannot be written: {}", path.string(), why)};
}

// A file under a temporary name beside its own; gone unless it is kept.
class PendingFile {
 public:
  explicit PendingFile(fs::path target)
      : target_(std::move(target)),
        temporary_(target_.parent_path() /
                   fmt::format(".{}.{}.part", target_.filename().string(), ::getpid())),
        out_(temporary_, std::ios::binary | std::ios::trunc) {}
  ~PendingFile() {
    std::error_code ignored;
    if (!kept_) fs::remove(temporary_, ignored);
  }
  bool write(const std::string& bytes) {
    return static_cast<bool>(out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())));
  }
  Done keep() {
    out_.close();
    if (!out_) return cannot_write(target_, "the disk may be full");
    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) return cannot_write(target_, error.message());
    kept_ = true;
    return done();
  }
  bool open() const { return out_.is_open(); }

 private:
  fs::path target_, temporary_;
  std::ofstream out_;
  bool kept_ = false;
};

Done download_file(const Connection& connection, v1::ArtifactService::Stub& stub, const v1::ResultFile& file,
                   const fs::path& target) {
  PendingFile pending(target);
  if (!pending.open()) return cannot_write(target, std::strerror(errno));
  transport::Sha256 hash;
  std::int64_t received = 0;
  std::optional<Failure> local;
  Backoff backoff(std::chrono::milliseconds(100), std::chrono::milliseconds(2000));
  for (int left = kAttemptsWithoutProgress;;) {
    const std::int64_t before = received;
    const grpc::Status status = call_once(connection, kStreamDeadline, [&](grpc::ClientContext& context) {
      v1::DownloadArtifactRequest request;
      request.set_sha256(file.sha256());
      request.set_offset(received);
      const auto reader = stub.Download(&context, request);
      v1::DownloadArtifactResponse response;
      while (!local && reader->Read(&response)) {
        received += static_cast<std::int64_t>(response.chunk().size());
        if (received > file.size_bytes()) {
          local = Failure{FailureKind::kInternal,
                          fmt::format("{}: the server sends more than it said", file.path())};
        } else if (!pending.write(response.chunk())) {
          local = cannot_write(target, "the disk may be full");
        }
        hash.add(response.chunk());
      }
      if (local) context.TryCancel();
      return reader->Finish();
    });
    if (local) return *local;
    if (status.ok()) break;
    if (received > before) left = kAttemptsWithoutProgress;
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE || --left <= 0)
      return to_failure(status, connection);
    if (!connection.clock->wait(backoff.next(), connection.stop)) {
      return Failure{FailureKind::kInterrupted, "interrupted"};
    }
  }
  if (received != file.size_bytes() || hash.hex() != file.sha256()) {
    return Failure{
        FailureKind::kInternal,
        fmt::format("{}: came damaged (its hash is not the job's); download it again", file.path())};
  }
  return pending.keep();
}

}  // namespace

Result<std::vector<fs::path>> download_results(const Connection& connection, const v1::Job& job,
                                               const fs::path& folder) {
  std::vector<fs::path> targets;
  for (const v1::ResultFile& file : job.files()) {
    auto target = path_inside(folder, file.path());
    if (!target) return target.failure();
    targets.push_back(*std::move(target));
  }
  const auto stub = v1::ArtifactService::NewStub(connection.channel);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return cannot_write(folder, error.message());
  for (int i = 0; i < job.files_size(); ++i) {
    const fs::path& target = targets[static_cast<std::size_t>(i)];
    fs::create_directories(target.parent_path(), error);
    if (error) return cannot_write(target.parent_path(), error.message());
    if (auto got = download_file(connection, *stub, job.files(i), target); !got) return got.failure();
  }
  return targets;
}

}  // namespace skinframe::client
