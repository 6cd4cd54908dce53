// SPDX-License-Identifier: Apache-2.0
#include "server/api/upload_call.h"

#include "server/api/answer.h"
#include "server/api/caller.h"

namespace skinframe::server {

UploadCall::UploadCall(const Parts& parts, const grpc::CallbackServerContext& context,
                       v1::UploadArtifactResponse& response)
    : parts_(parts), context_(context), response_(response) {
  StartRead(&message_);
}

void UploadCall::OnReadDone(bool ok) {
  parts_.executor.post([this, ok] {
    if (!ok) return end(take_end());
    const absl::Status status = take_message();
    const bool there_already = status.ok() && upload_ == nullptr;
    if (!status.ok() || there_already) return end(status);
    StartRead(&message_);
  });
}

absl::Status UploadCall::take_message() {
  if (!header_taken_) return take_header();
  if (message_.part_case() != v1::UploadArtifactRequest::kChunk) {
    return absl::InvalidArgumentError("after the header only chunks may come");
  }
  return upload_->append(message_.chunk());
}

absl::Status UploadCall::take_header() {
  if (message_.part_case() != v1::UploadArtifactRequest::kHeader) {
    return absl::InvalidArgumentError("the first message must be the header");
  }
  header_ = message_.header();
  header_taken_ = true;
  const auto shelf = shelf_of(parts_, context_);
  if (!shelf.ok()) return shelf.status();
  if (absl::Status status = shelf->permit_upload(parts_, header_.sha256(), header_.size_bytes());
      !status.ok())
    return status;
  auto upload = shelf->store->upload(header_.sha256(), header_.size_bytes(), header_.offset());
  if (!upload.ok()) return upload.status();
  upload_ = *std::move(upload);
  return absl::OkStatus();
}

absl::Status UploadCall::take_end() {
  if (upload_ == nullptr) return absl::InvalidArgumentError("the header is missing");
  return upload_->finish();
}

void UploadCall::end(const absl::Status& status) {
  upload_.reset();  // before the client hears of it, so that it may try again at once
  if (status.ok()) {
    response_.set_sha256(header_.sha256());
    response_.set_size_bytes(header_.size_bytes());
  }
  Finish(to_grpc(status));
}

}  // namespace skinframe::server
