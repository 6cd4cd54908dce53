// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <cstdint>
#include <istream>

#include "proto/transport/sha256.h"
#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::transport {

// One Upload call: tells what the file is and sends what lies behind offset, where `in` must stand. The
// answer is the server's, with which it may have ended the stream before the file ended.
grpc::Status send_rest(v1::ArtifactService::StubInterface& stub, grpc::ClientContext& context,
                       const FileDigest& file, std::int64_t offset, std::istream& in);

}  // namespace skinframe::transport
