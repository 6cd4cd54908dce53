// SPDX-License-Identifier: Apache-2.0
#include "server/api/download_call.h"

#include <fmt/format.h>

#include <algorithm>

#include "server/api/answer.h"
#include "server/api/caller.h"

namespace skinframe::server {
namespace {
constexpr std::int64_t kChunkBytes = 256 * 1024;
}

DownloadCall::DownloadCall(const Parts& parts, const grpc::CallbackServerContext& context,
                           const v1::DownloadArtifactRequest& request)
    : parts_(parts), context_(context) {
  parts_.executor.post([this, request] {
    if (auto status = open(request); !status.ok()) return Finish(to_grpc(status));
    send_next();
  });
}

absl::Status DownloadCall::open(const v1::DownloadArtifactRequest& request) {
  if (request.length() < 0) return absl::InvalidArgumentError("length must not be negative");
  const auto shelf = shelf_of(parts_, context_);
  if (!shelf.ok()) return shelf.status();
  auto file = shelf->store->read(request.sha256());
  if (!file.ok()) return file.status();
  file_ = *std::move(file);
  const auto size = file_.size();
  if (!size.ok()) return size.status();
  if (request.offset() < 0 || request.offset() > *size) {
    return absl::OutOfRangeError(
        fmt::format("offset is {}, the artifact has {} bytes", request.offset(), *size));
  }
  at_ = request.offset();
  end_ = request.length() == 0 ? *size : at_ + std::min(request.length(), *size - at_);
  return absl::OkStatus();
}

void DownloadCall::send_next() {
  if (at_ == end_) return Finish(grpc::Status::OK);
  const auto want = static_cast<std::size_t>(std::min(kChunkBytes, end_ - at_));
  auto bytes = file_.read_at(at_, want);
  if (!bytes.ok()) return Finish(to_grpc(bytes.status()));
  if (bytes->size() != want)
    return Finish(to_grpc(absl::InternalError("an artifact became shorter while it was read")));
  at_ += static_cast<std::int64_t>(want);
  message_.set_chunk(*std::move(bytes));
  StartWrite(&message_);
}

void DownloadCall::OnWriteDone(bool ok) {
  if (!ok) return Finish({grpc::StatusCode::CANCELLED, "the client hung up"});
  parts_.executor.post([this] { send_next(); });
}

}  // namespace skinframe::server
