// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/completion_call.h"

#include <grpcpp/client_context.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <string_view>

#include "proto/transport/backoff.h"
#include "worker/agent/wait.h"

namespace skinframe::agent {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::minutes kCompletionPatience{10};  // enough to make room on a full disk

bool may_be_taken_later(grpc::StatusCode code) {
  return code == grpc::StatusCode::UNAVAILABLE || code == grpc::StatusCode::DEADLINE_EXCEEDED ||
         code == grpc::StatusCode::RESOURCE_EXHAUSTED;  // its disk is full
}

}  // namespace

void send_completion(v1::WorkerService::StubInterface& stub, const v1::CompleteRequest& completion,
                     int attempt, Heartbeater& heartbeater, const std::stop_token& worker_stop) {
  transport::Backoff backoff(std::chrono::milliseconds(100), std::chrono::milliseconds(1000));
  const auto patience = steady_clock::now() + kCompletionPatience;
  for (bool first = true;; first = false) {
    grpc::ClientContext context;
    context.set_wait_for_ready(!first);  // the channel connects only while a call waits for it
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(5));
    v1::CompleteResponse response;
    const grpc::Status status = stub.Complete(&context, completion, &response);
    if (status.ok()) {
      spdlog::info("job={} attempt {} ended: {} {} {}", completion.job_id(), attempt,
                   v1::JobState_Name(completion.state()), v1::Reason_Name(completion.reason()),
                   completion.detail());
      return;
    }
    const bool again = may_be_taken_later(status.error_code());
    if (again && !worker_stop.stop_requested() && steady_clock::now() < patience) heartbeater.prolong_lease();
    const auto delay = backoff.next();
    if (!again || steady_clock::now() + delay >= heartbeater.lease_expiry()) {
      spdlog::warn("job={} the completion was not accepted: {}", completion.job_id(), status.error_message());
      return;
    }
    wait_unless_stopped(std::stop_token(), delay);  // bounded by the lease, not by the agent's end
  }
}

std::string word_of(const std::string& enum_name) {
  for (const std::string_view prefix : {"JOB_STATE_", "REASON_"})
    if (enum_name.starts_with(prefix))
      return enum_name.ends_with("UNSPECIFIED") ? "NONE" : enum_name.substr(prefix.size());
  return enum_name;
}

}  // namespace skinframe::agent
