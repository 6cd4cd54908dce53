// SPDX-License-Identifier: Apache-2.0
#include "server/api/artifact_service.h"

#include "server/api/answer.h"
#include "server/api/caller.h"
#include "server/api/download_call.h"
#include "server/api/upload_call.h"

namespace skinframe::server {

grpc::ServerUnaryReactor* ArtifactService::Stat(grpc::CallbackServerContext* context,
                                                const v1::StatArtifactRequest* request,
                                                v1::StatArtifactResponse* response) {
  return answer_on(parts_.executor, context, [=, this]() -> absl::Status {
    const auto shelf = shelf_of(parts_, *context);
    if (!shelf.ok()) return shelf.status();
    const auto facts = shelf->store->stat(request->sha256());
    if (!facts.ok()) return facts.status();
    response->set_complete(facts->complete);
    response->set_size_bytes(facts->size_bytes);
    response->set_resume_offset(facts->resume_offset);
    return absl::OkStatus();
  });
}

grpc::ServerReadReactor<v1::UploadArtifactRequest>* ArtifactService::Upload(
    grpc::CallbackServerContext* context, v1::UploadArtifactResponse* response) {
  return new UploadCall(parts_, *context, *response);
}

grpc::ServerWriteReactor<v1::DownloadArtifactResponse>* ArtifactService::Download(
    grpc::CallbackServerContext* context, const v1::DownloadArtifactRequest* request) {
  return new DownloadCall(parts_, *context, *request);
}

}  // namespace skinframe::server
