// SPDX-License-Identifier: Apache-2.0
// One Download stream: reads a chunk from the file on the executor, writes it, reads the next.
#pragma once

#include <cstdint>

#include "server/api/parts.h"
#include "server/artifacts/file.h"
#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::server {

class DownloadCall final : public grpc::ServerWriteReactor<v1::DownloadArtifactResponse> {
 public:
  DownloadCall(const Parts& parts, const grpc::CallbackServerContext& context,
               const v1::DownloadArtifactRequest& request);
  void OnWriteDone(bool ok) override;
  void OnDone() override { delete this; }

 private:
  absl::Status open(const v1::DownloadArtifactRequest& request);
  void send_next();

  Parts parts_;
  const grpc::CallbackServerContext& context_;  // there until OnDone
  File file_;
  std::int64_t at_ = 0;
  std::int64_t end_ = 0;  // first byte not wanted
  v1::DownloadArtifactResponse message_;
};

}  // namespace skinframe::server
