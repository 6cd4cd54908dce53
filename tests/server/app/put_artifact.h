// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <grpcpp/client_context.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "proto/transport/upload_stream.h"

namespace skinframe::server {

inline void set_deadline(grpc::ClientContext& context) {
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
}

// Its SHA-256, when the server has it.
inline std::string put_artifact(v1::ArtifactService::StubInterface& artifacts, const std::string& content) {
  std::istringstream in(content);
  const transport::FileDigest digest = transport::digest_of(in);
  in.clear();
  in.seekg(0);
  grpc::ClientContext context;
  set_deadline(context);
  EXPECT_TRUE(transport::send_rest(artifacts, context, digest, 0, in).ok());
  return digest.sha256;
}

}  // namespace skinframe::server
