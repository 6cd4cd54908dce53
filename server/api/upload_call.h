// SPDX-License-Identifier: Apache-2.0
// One Upload stream: reads a message, writes its chunk on the executor, reads the next. So a client is never
// faster than the disk, and one chunk is in memory.
#pragma once

#include <memory>

#include "server/api/parts.h"
#include "server/artifacts/upload.h"
#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::server {

class UploadCall final : public grpc::ServerReadReactor<v1::UploadArtifactRequest> {
 public:
  UploadCall(const Parts& parts, const grpc::CallbackServerContext& context,
             v1::UploadArtifactResponse& response);
  void OnReadDone(bool ok) override;
  void OnDone() override { delete this; }

 private:
  absl::Status take_header();
  absl::Status take_message();
  absl::Status take_end();
  void end(const absl::Status& status);

  Parts parts_;
  const grpc::CallbackServerContext& context_;  // there until OnDone
  v1::UploadArtifactResponse& response_;
  v1::UploadArtifactRequest message_;
  v1::UploadArtifactRequest::Header header_;
  bool header_taken_ = false;
  std::unique_ptr<Upload> upload_;  // null after the header: the artifact is there already
};

}  // namespace skinframe::server
