// SPDX-License-Identifier: Apache-2.0
#include "client/jobs/watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "client/call/retry.h"
#include "skinframe/v1/job.grpc.pb.h"

namespace skinframe::client {
namespace {

// Longer than any job; the keepalive, not this, notices a server that is cut off.
constexpr std::chrono::hours kStreamDeadline{24 * 30};

enum class Seen { kNothing, kEvents, kFinalState, kEnough };

// The server is away, or has as many watches as it takes. CANCELLED, where nobody on this side wants to
// leave: its stop cut the stream.
bool may_come_back(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::UNAVAILABLE ||
         status.error_code() == grpc::StatusCode::CANCELLED ||
         (status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED && asked_delay(status).has_value());
}

class Watch {
 public:
  Watch(const Connection& connection, const std::string& job_id, std::int64_t after,
        const EventHandler& handler)
      : connection_(connection),
        stub_(v1::JobService::NewStub(connection.channel)),
        job_id_(job_id),
        last_(after),
        handler_(handler) {}

  // One stream, from where the last one broke.
  grpc::Status follow(Seen& seen) {
    return call_once(connection_, kStreamDeadline, [&](grpc::ClientContext& context) {
      v1::WatchJobRequest request;
      request.set_job_id(job_id_);
      request.set_after_sequence(last_);
      const auto reader = stub_->WatchJob(&context, request);
      v1::JobEvent event;
      bool leave = false;
      while (!leave && reader->Read(&event)) {
        if (event.sequence() != last_ + 1) {
          broken_ =
              Failure{FailureKind::kInternal, fmt::format("event {} came after {}", event.sequence(), last_)};
          break;
        }
        last_ = event.sequence();
        const bool more = handler_(event);
        const bool ended = event.has_state() && is_final(event.state().state());
        seen = ended ? Seen::kFinalState : more ? Seen::kEvents : Seen::kEnough;
        leave = seen != Seen::kEvents;
      }
      if (leave || broken_) context.TryCancel();
      grpc::Status status = reader->Finish();
      if (status.error_code() == grpc::StatusCode::OUT_OF_RANGE)
        first_available_ = trailing_number(context, "first-available-sequence");
      return status;
    });
  }

  // After a stream that ended OUT_OF_RANGE: goes on behind events that were thinned out. False: none were.
  bool skip_thinned(const WatchOptions& options) {
    const auto next = std::exchange(first_available_, std::nullopt);
    if (!next || *next <= last_ + 1) return false;
    options.on_thinned(last_ + 1, *next - 1);
    last_ = *next - 1;
    return true;
  }

  // Whether the job had ended with the last event seen: a stream that starts there ends without a word.
  Result<bool> ended_already() {
    v1::GetJobRequest request;
    request.set_job_id(job_id_);
    v1::Job job;
    const auto status = call_with_retries(connection_, {}, [&](grpc::ClientContext& context) {
      return stub_->GetJob(&context, request, &job);
    });
    if (!status.ok()) return to_failure(status, connection_);
    return is_final(job.state()) && job.last_sequence() <= last_;
  }

  const std::optional<Failure>& broken() const { return broken_; }

 private:
  const Connection& connection_;
  std::unique_ptr<v1::JobService::Stub> stub_;
  const std::string& job_id_;
  std::int64_t last_;
  const EventHandler& handler_;
  std::optional<Failure> broken_;
  std::optional<std::int64_t> first_available_;
};

}  // namespace

bool is_final(v1::JobState state) {
  return state == v1::JOB_STATE_SUCCEEDED || state == v1::JOB_STATE_FAILED ||
         state == v1::JOB_STATE_CANCELLED;
}

Done watch_job(const Connection& connection, const std::string& job_id, const WatchOptions& options,
               const EventHandler& handler) {
  Watch watch(connection, job_id, options.after_sequence, handler);
  Backoff backoff(std::chrono::milliseconds(100), std::chrono::milliseconds(2000));
  auto last_sign = connection.clock->now();
  bool lost = false;
  while (true) {
    Seen seen = Seen::kNothing;
    const grpc::Status status = watch.follow(seen);
    if (watch.broken()) return *watch.broken();
    if (seen == Seen::kFinalState || seen == Seen::kEnough) return done();
    if (connection.stop.stop_requested()) return Failure{FailureKind::kInterrupted, "interrupted"};
    if (watch.skip_thinned(options)) continue;
    if (status.ok()) {
      const auto ended = watch.ended_already();
      if (ended && *ended) return done();
      if (!ended && ended.failure().kind != FailureKind::kUnreachable) return ended.failure();
    } else if (!may_come_back(status)) {
      return to_failure(status, connection);
    }
    if (seen == Seen::kEvents) {
      last_sign = connection.clock->now();
      backoff.reset();
      lost = false;
    }
    if (connection.clock->now() - last_sign >= options.patience) return to_failure(status, connection);
    if (!lost && !status.ok()) options.on_lost();
    lost = true;
    const auto delay = backoff.next();
    if (!connection.clock->wait(std::max(delay, asked_delay(status).value_or(delay)), connection.stop)) {
      return Failure{FailureKind::kInterrupted, "interrupted"};
    }
  }
}

}  // namespace skinframe::client
