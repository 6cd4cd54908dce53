// SPDX-License-Identifier: Apache-2.0
// An artifact store in memory that behaves as artifact.proto says, and that breaks off when a test asks for
// it.
#pragma once

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "skinframe/v1/artifact.grpc.pb.h"

namespace skinframe::fake {

class FakeArtifacts final : public v1::ArtifactService::Service {
 public:
  std::mutex mutex;
  std::map<std::string, std::string> complete;  // by sha256
  std::map<std::string, std::string> partial;   // what is kept of interrupted uploads
  std::vector<std::int64_t> upload_offsets;     // of each upload's header
  std::vector<std::int64_t> download_offsets;   // of each download
  std::size_t break_upload_after = 0;           // bytes; once; 0: never
  std::size_t break_download_after = 0;         // bytes; once; 0: never
  // SHA-256, where a test has one at hand: an upload of another content is then DATA_LOSS.
  std::function<std::string(const std::string&)> hash;

  std::vector<std::string> leases_shown;  // "JOB TOKEN" of each call's metadata; " " where there is none

  grpc::Status Stat(grpc::ServerContext* context, const v1::StatArtifactRequest* request,
                    v1::StatArtifactResponse* response) override {
    const std::lock_guard lock(mutex);
    note_lease(*context);
    const auto it = complete.find(request->sha256());
    if (it != complete.end()) {
      response->set_complete(true);
      response->set_size_bytes(static_cast<std::int64_t>(it->second.size()));
    } else {
      response->set_resume_offset(static_cast<std::int64_t>(partial[request->sha256()].size()));
    }
    return grpc::Status::OK;
  }

  grpc::Status Upload(grpc::ServerContext* context, grpc::ServerReader<v1::UploadArtifactRequest>* reader,
                      v1::UploadArtifactResponse* response) override {
    v1::UploadArtifactRequest part;
    if (!reader->Read(&part) || !part.has_header()) return {grpc::StatusCode::INVALID_ARGUMENT, "no header"};
    const auto header = part.header();
    const std::lock_guard lock(mutex);
    note_lease(*context);
    upload_offsets.push_back(header.offset());
    std::string& kept = partial[header.sha256()];
    if (header.offset() != static_cast<std::int64_t>(kept.size())) {
      return {grpc::StatusCode::FAILED_PRECONDITION, "not where the kept part ends"};
    }
    while (reader->Read(&part)) {
      kept += part.chunk();
      if (break_upload_after != 0 && kept.size() >= break_upload_after) {
        break_upload_after = 0;
        return {grpc::StatusCode::UNAVAILABLE, "connection lost"};
      }
    }
    if (static_cast<std::int64_t>(kept.size()) != header.size_bytes()) {
      partial.erase(header.sha256());
      return {grpc::StatusCode::DATA_LOSS, "another size"};
    }
    if (hash && hash(kept) != header.sha256()) {
      partial.erase(header.sha256());
      return {grpc::StatusCode::DATA_LOSS, "another content"};
    }
    complete[header.sha256()] = std::move(kept);
    partial.erase(header.sha256());
    response->set_sha256(header.sha256());
    response->set_size_bytes(header.size_bytes());
    return grpc::Status::OK;
  }

  grpc::Status Download(grpc::ServerContext* context, const v1::DownloadArtifactRequest* request,
                        grpc::ServerWriter<v1::DownloadArtifactResponse>* writer) override {
    constexpr std::size_t kChunk = 1000;
    const std::lock_guard lock(mutex);
    note_lease(*context);
    download_offsets.push_back(request->offset());
    const auto it = complete.find(request->sha256());
    if (it == complete.end()) return {grpc::StatusCode::NOT_FOUND, "no such artifact"};
    for (auto at = static_cast<std::size_t>(request->offset()); at < it->second.size(); at += kChunk) {
      v1::DownloadArtifactResponse response;
      response.set_chunk(it->second.substr(at, kChunk));
      writer->Write(response);
      if (break_download_after != 0 && at + kChunk >= break_download_after) {
        break_download_after = 0;
        return {grpc::StatusCode::UNAVAILABLE, "connection lost"};
      }
    }
    return grpc::Status::OK;
  }

 private:
  void note_lease(const grpc::ServerContext& context) {
    const auto shown = [&](const char* key) {
      const auto it = context.client_metadata().find(key);
      return it == context.client_metadata().end() ? "" : std::string(it->second.data(), it->second.size());
    };
    leases_shown.push_back(shown("skinframe-job-id") + " " + shown("skinframe-fencing-token"));
  }
};

}  // namespace skinframe::fake
