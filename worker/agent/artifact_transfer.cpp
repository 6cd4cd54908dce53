// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/artifact_transfer.h"

#include <fmt/format.h>
#include <grpcpp/client_context.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "proto/transport/backoff.h"
#include "proto/transport/upload_stream.h"
#include "worker/agent/wait.h"

namespace skinframe::agent {
namespace {

// A stream that stands still for this long is as good as cut. Enough for 2 GiB over a slow link.
constexpr std::chrono::minutes kStreamDeadline{10};

grpc::Status disk_error(const std::filesystem::path& path, const char* what) {
  return {grpc::StatusCode::INTERNAL, fmt::format("{}: {}: {}", path.string(), what, std::strerror(errno))};
}

grpc::Status stopped() { return {grpc::StatusCode::CANCELLED, "told to stop"}; }

void show(const LeaseProof& lease, grpc::ClientContext& context) {
  if (lease.job_id.empty()) return;
  context.AddMetadata("skinframe-job-id", lease.job_id);
  context.AddMetadata("skinframe-fencing-token", std::to_string(lease.fencing_token));
}

// Answers that tell to try again though the server is there; so many, then the answer stands.
constexpr int kMaxRefusals = 100;

// Calls attempt(context) until it gives something else than UNAVAILABLE (or a code that `again` takes for
// it).
template <class Attempt, class Again>
grpc::Status until_answered(const std::stop_token& stop, const LeaseProof& lease, Attempt attempt,
                            Again again) {
  transport::Backoff backoff(std::chrono::milliseconds(100), std::chrono::milliseconds(2000));
  int refusals = 0;
  while (!stop.stop_requested()) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + kStreamDeadline);
    show(lease, context);
    grpc::Status status;
    {
      const std::stop_callback cancel(stop, [&] { context.TryCancel(); });
      status = attempt(context);
    }
    if (stop.stop_requested()) break;
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE) {
      if (!again(status) || ++refusals > kMaxRefusals) return status;
    }
    if (!wait_unless_stopped(stop, backoff.next())) break;
  }
  return stopped();
}

}  // namespace

Result<FileDigest> digest_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return io_error(fmt::format("{}: {}", path.string(), std::strerror(errno)));
  FileDigest out = transport::digest_of(in);
  if (in.bad()) return io_error(fmt::format("{}: cannot be read", path.string()));
  return out;
}

grpc::Status download_artifact(v1::ArtifactService::StubInterface& stub, const std::string& sha256,
                               const std::filesystem::path& path, std::stop_token stop,
                               const LeaseProof& lease) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  if (!out) return disk_error(path, "cannot be written");
  transport::Sha256 hash;
  std::int64_t received = 0;
  const grpc::Status status = until_answered(
      stop, lease,
      [&](grpc::ClientContext& context) {
        v1::DownloadArtifactRequest request;
        request.set_sha256(sha256);
        request.set_offset(received);
        const auto reader = stub.Download(&context, request);
        v1::DownloadArtifactResponse response;
        while (reader->Read(&response)) {
          const std::string& chunk = response.chunk();
          if (!out.write(chunk.data(), static_cast<std::streamsize>(chunk.size()))) {
            context.TryCancel();
            reader->Finish();
            return disk_error(path, "cannot be written");
          }
          hash.add(chunk);
          received += static_cast<std::int64_t>(chunk.size());
        }
        return reader->Finish();
      },
      [](const grpc::Status&) { return false; });
  if (!status.ok()) return status;
  out.close();
  if (!out) return disk_error(path, "cannot be written");
  if (hash.hex() != sha256) {
    return {grpc::StatusCode::DATA_LOSS, fmt::format("artifact {} came with another content", sha256)};
  }
  return grpc::Status::OK;
}

grpc::Status upload_artifact(v1::ArtifactService::StubInterface& stub, const std::filesystem::path& path,
                             const FileDigest& digest, std::stop_token stop, const LeaseProof& lease) {
  std::int64_t kept = 0;
  bool kept_part_was_wrong = false;
  const auto attempt = [&](grpc::ClientContext& context) -> grpc::Status {
    grpc::ClientContext stat_context;
    stat_context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
    show(lease, stat_context);
    v1::StatArtifactRequest stat_request;
    stat_request.set_sha256(digest.sha256);
    v1::StatArtifactResponse stat;
    if (const auto status = stub.Stat(&stat_context, stat_request, &stat); !status.ok()) return status;
    if (stat.complete()) return grpc::Status::OK;
    kept = stat.resume_offset();

    std::ifstream in(path, std::ios::binary);
    in.seekg(kept);
    if (!in) return disk_error(path, "cannot be read");
    return transport::send_rest(stub, context, digest, kept, in);
  };
  return until_answered(stop, lease, attempt, [&](const grpc::Status& status) {
    // DATA_LOSS: the part that the server had kept was not of this file. It has dropped it: once more, from
    // the beginning.
    if (status.error_code() == grpc::StatusCode::DATA_LOSS && kept > 0) {
      return !std::exchange(kept_part_was_wrong, true);
    }
    // ABORTED: another upload of the same content is under way. FAILED_PRECONDITION: it moved on; Stat again.
    return status.error_code() == grpc::StatusCode::ABORTED ||
           status.error_code() == grpc::StatusCode::FAILED_PRECONDITION;
  });
}

}  // namespace skinframe::agent
