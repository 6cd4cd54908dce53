// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/checkpoint_sender.h"

#include <grpcpp/client_context.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <system_error>
#include <utility>

#include "worker/agent/artifact_transfer.h"

namespace skinframe::agent {

CheckpointSender::CheckpointSender(ServerStubs stubs, const v1::Assignment& assignment,
                                   std::filesystem::path job_folder)
    : stubs_(stubs),
      job_id_(assignment.job_id()),
      fencing_token_(assignment.fencing_token()),
      folder_(std::move(job_folder)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

CheckpointSender::~CheckpointSender() = default;

void CheckpointSender::ready(std::string stage) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(stage);
  }
  wake_.notify_one();
}

void CheckpointSender::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::string stage;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return waiting_.has_value(); })) return;
      stage = *std::exchange(waiting_, std::nullopt);
    }
    send(stage, stop);
  }
}

void CheckpointSender::send(const std::string& stage, const std::stop_token& stop) {
  // Taken aside: the job may rename the next one into its place at any moment.
  const auto path = folder_ / "checkpoint-sending";
  std::error_code error;
  std::filesystem::rename(folder_ / "checkpoint", path, error);
  if (error) return;  // an earlier turn has taken it already
  const auto digest = digest_file(path);
  if (!digest) {
    spdlog::warn("job={} {}", job_id_, digest.error().message);
    return;
  }
  grpc::Status status =
      upload_artifact(stubs_.artifacts, path, *digest, stop, LeaseProof{job_id_, fencing_token_});
  if (status.ok()) {
    v1::CheckpointRequest request;
    request.set_job_id(job_id_);
    request.set_fencing_token(fencing_token_);
    request.mutable_checkpoint()->set_sha256(digest->sha256);
    request.mutable_checkpoint()->set_size_bytes(digest->size_bytes);
    request.mutable_checkpoint()->set_stage(stage);
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(5));
    v1::CheckpointResponse response;
    status = stubs_.worker.Checkpoint(&context, request, &response);
  }
  if (status.ok()) {
    spdlog::info("job={} checkpoint of {} bytes: {} is done", job_id_, digest->size_bytes, stage);
  } else if (!stop.stop_requested()) {
    spdlog::warn("job={} a checkpoint was not kept: {}", job_id_, status.error_message());
  }
}

}  // namespace skinframe::agent
