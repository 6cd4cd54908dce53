// SPDX-License-Identifier: GPL-3.0-or-later
// Files to and from the server's artifact store. Both go on where they were interrupted and try again while
// the server is UNAVAILABLE, until they are told to stop: the lease bounds how long that is worth while.
#pragma once

#include <grpcpp/support/status.h>

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <string_view>

#include "proto/transport/sha256.h"
#include "skinframe/v1/artifact.grpc.pb.h"
#include "worker/run/result.h"

namespace skinframe::agent {

using transport::FileDigest;

// For which job, and by which lease, a worker asks: its files are those of the job's tenant.
struct LeaseProof {
  std::string job_id;  // empty: for no job
  std::int64_t fencing_token = 0;
};

Result<FileDigest> digest_file(const std::filesystem::path& path);

// The file at path is whole and has the hash that names it, or the status is not OK:
// NOT_FOUND, DATA_LOSS (what came has another hash), CANCELLED (stop), INTERNAL (the disk), or the server's.
grpc::Status download_artifact(v1::ArtifactService::StubInterface& stub, const std::string& sha256,
                               const std::filesystem::path& path, std::stop_token stop,
                               const LeaseProof& lease = {});

// Stat first: what the server has costs nothing, an interrupted upload goes on.
grpc::Status upload_artifact(v1::ArtifactService::StubInterface& stub, const std::filesystem::path& path,
                             const FileDigest& digest, std::stop_token stop, const LeaseProof& lease = {});

}  // namespace skinframe::agent
