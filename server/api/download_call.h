// SPDX-License-Identifier: Apache-2.0
// One Download stream: reads a chunk from the file on the executor, writes it, reads the next.
#pragma once

#include <cstdint>

#include "server/artifacts/artifact_store.h"
#include "server/executor/executor.h"
#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::server {

class DownloadCall final : public grpc::ServerWriteReactor<v1::DownloadArtifactResponse> {
 public:
  DownloadCall(ArtifactStore& artifacts, Executor& executor, const v1::DownloadArtifactRequest& request);
  void OnWriteDone(bool ok) override;
  void OnDone() override { delete this; }

 private:
  absl::Status open(const v1::DownloadArtifactRequest& request);
  void send_next();

  ArtifactStore& artifacts_;
  Executor& executor_;
  File file_;
  std::int64_t at_ = 0;
  std::int64_t end_ = 0;  // first byte not wanted
  v1::DownloadArtifactResponse message_;
};

}  // namespace skinframe::server
