// SPDX-License-Identifier: Apache-2.0
#include "client/transfer/upload.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "client/call/retry.h"
#include "proto/transport/upload_stream.h"
#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::client {
namespace {

constexpr int kAttemptsWithoutProgress = 6;
constexpr std::chrono::minutes kStreamDeadline{30};

grpc::Status send(v1::ArtifactService::Stub& stub, grpc::ClientContext& context,
                  const std::filesystem::path& path, const FileDigest& digest, std::int64_t offset) {
  std::ifstream in(path, std::ios::binary);
  in.seekg(offset);
  if (!in) return {grpc::StatusCode::DATA_LOSS, "the file changed while it was uploaded"};
  return transport::send_rest(stub, context, digest, offset, in);
}

bool worth_another(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::ABORTED:              // another upload of the same content is under way
    case grpc::StatusCode::FAILED_PRECONDITION:  // the kept part ends elsewhere by now: Stat again
      return true;
    default:
      return false;
  }
}

}  // namespace

Result<FileDigest> upload_input(const Connection& connection, const std::filesystem::path& path) {
  auto digest = digest_input_file(path);
  if (!digest) return digest;
  const auto stub = v1::ArtifactService::NewStub(connection.channel);
  Backoff backoff(std::chrono::milliseconds(100), std::chrono::milliseconds(2000));
  std::int64_t kept = -1;
  bool kept_part_was_wrong = false;
  for (int left = kAttemptsWithoutProgress; left > 0; --left) {
    v1::StatArtifactRequest request;
    request.set_sha256(digest->sha256);
    v1::StatArtifactResponse stat;
    grpc::Status status = call_with_retries(
        connection, {}, [&](grpc::ClientContext& context) { return stub->Stat(&context, request, &stat); });
    if (!status.ok()) return to_failure(status, connection);
    if (stat.complete()) return digest;
    if (stat.resume_offset() > kept) left = kAttemptsWithoutProgress;
    kept = stat.resume_offset();
    status = call_once(connection, kStreamDeadline, [&](grpc::ClientContext& context) {
      return send(*stub, context, path, *digest, kept);
    });
    if (status.ok()) return digest;
    if (status.error_code() == grpc::StatusCode::DATA_LOSS && kept > 0 && !kept_part_was_wrong) {
      kept_part_was_wrong = true;  // and the server has dropped it: once more, from the beginning
      kept = -1;
      continue;
    }
    if (status.error_code() == grpc::StatusCode::INVALID_ARGUMENT ||
        status.error_code() == grpc::StatusCode::DATA_LOSS) {
      return Failure{FailureKind::kInput, fmt::format("{}: {}", path.string(), status.error_message())};
    }
    if (!worth_another(status) || left == 1) return to_failure(status, connection);
    const auto delay = backoff.next();
    if (!connection.clock->wait(std::max(delay, asked_delay(status).value_or(delay)), connection.stop)) break;
  }
  return Failure{FailureKind::kInterrupted, "interrupted"};
}

}  // namespace skinframe::client
