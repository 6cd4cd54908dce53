// SPDX-License-Identifier: Apache-2.0
// One Upload stream: reads a message, writes its chunk on the executor, reads the next. So a client is never
// faster than the disk, and one chunk is in memory.
#pragma once

#include <memory>

#include "server/artifacts/artifact_store.h"
#include "server/artifacts/upload.h"
#include "server/executor/executor.h"
#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::server {

class UploadCall final : public grpc::ServerReadReactor<v1::UploadArtifactRequest> {
 public:
  UploadCall(ArtifactStore& artifacts, Executor& executor, v1::UploadArtifactResponse& response);
  void OnReadDone(bool ok) override;
  void OnDone() override { delete this; }

 private:
  absl::Status take_header();
  absl::Status take_message();
  absl::Status take_end();
  void end(const absl::Status& status);

  ArtifactStore& artifacts_;
  Executor& executor_;
  v1::UploadArtifactResponse& response_;
  v1::UploadArtifactRequest message_;
  v1::UploadArtifactRequest::Header header_;
  bool header_taken_ = false;
  std::unique_ptr<Upload> upload_;  // null after the header: the artifact is there already
};

}  // namespace skinframe::server
