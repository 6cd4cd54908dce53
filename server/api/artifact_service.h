// SPDX-License-Identifier: Apache-2.0
// skinframe.v1.ArtifactService. What each call promises stands in artifact.proto.
#pragma once

#include "server/api/parts.h"
#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::server {

class ArtifactService final : public v1::ArtifactService::CallbackService {
 public:
  explicit ArtifactService(const Parts& parts) : parts_(parts) {}

  grpc::ServerUnaryReactor* Stat(grpc::CallbackServerContext* context, const v1::StatArtifactRequest* request,
                                 v1::StatArtifactResponse* response) override;
  grpc::ServerReadReactor<v1::UploadArtifactRequest>* Upload(grpc::CallbackServerContext* context,
                                                             v1::UploadArtifactResponse* response) override;
  grpc::ServerWriteReactor<v1::DownloadArtifactResponse>* Download(
      grpc::CallbackServerContext* context, const v1::DownloadArtifactRequest* request) override;

 private:
  Parts parts_;
};

}  // namespace skinframe::server
