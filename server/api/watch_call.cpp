// SPDX-License-Identifier: Apache-2.0
#include "server/api/watch_call.h"

#include <fmt/format.h>

#include <utility>

#include "server/api/answer.h"
#include "server/api/caller.h"
#include "server/jobs/transitions.h"

namespace skinframe::server {
grpc::ServerWriteReactor<v1::JobEvent>* WatchCall::start(const Parts& parts,
                                                         grpc::CallbackServerContext& context,
                                                         const std::string& job_id,
                                                         std::int64_t after_sequence) {
  const std::shared_ptr<WatchCall> call(new WatchCall(parts, context, job_id, after_sequence));
  call->self_ = call;
  parts.executor.post([call] { call->begin(); });
  return call.get();
}

void WatchCall::begin() {
  const auto tenant = tenant_of(parts_, context_);
  if (!tenant.ok()) return end(tenant.status());
  if (auto status = parts_.hub.subscribe(job_id_, shared_from_this()); !status.ok()) return end(status);
  const auto record = parts_.store.get(job_id_);
  if (!record.ok()) return end(record.status());
  if (auto status = check_owner(*record, *tenant); !status.ok()) return end(status);
  const std::int64_t last = record->job.last_sequence();
  if (sequence_ < 0 || sequence_ > last) {
    return end(absl::OutOfRangeError(
        fmt::format("after_sequence is {}, the last event of job {} is {}", sequence_, job_id_, last)));
  }
  if (sequence_ == last && is_final(record->job.state())) return end(absl::OkStatus());
  read_page();
}

void WatchCall::read_page() {
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      news_ = false;  // what is committed from here on wakes again
    }
    if (stopped()) return;
    auto page = parts_.pages.after(job_id_, sequence_);
    if (!page.ok()) return end(page.status());
    if (!page->events->empty()) {
      page_ = *std::move(page);
      next_ = 0;
      return write_next();
    }
    const std::lock_guard lock(mutex_);
    if (news_ || stop_) continue;
    phase_ = Phase::kResting;
    return;
  }
}

void WatchCall::write_next() {
  if (stopped()) return;
  const v1::JobEvent& event = (*page_.events)[next_];
  if (event.sequence() != sequence_ + 1) return end_before(event);
  {
    const std::lock_guard lock(mutex_);
    phase_ = Phase::kWriting;
  }
  StartWrite(&event);
}

void WatchCall::end_before(const v1::JobEvent& next) {
  context_.AddTrailingMetadata("first-available-sequence", std::to_string(next.sequence()));
  end(absl::OutOfRangeError(
      fmt::format("events {} to {} of job {} were progress and are thinned out; watch on after {}",
                  sequence_ + 1, next.sequence() - 1, job_id_, next.sequence() - 1)));
}

void WatchCall::OnWriteDone(bool ok) {
  if (!ok) return end(absl::CancelledError("the client hung up"));
  const v1::JobEvent& written = (*page_.events)[next_];
  sequence_ = written.sequence();
  if (written.has_state() && is_final(written.state().state())) return end(absl::OkStatus());
  if (++next_ < page_.events->size()) return write_next();
  {
    const std::lock_guard lock(mutex_);
    const bool all = page_.to_the_end && !news_ && !stop_;
    phase_ = all ? Phase::kResting : Phase::kReading;
    if (all) return;
  }
  read_later();
}

void WatchCall::read_later() {
  parts_.executor.post([call = shared_from_this()] { call->read_page(); });
}

void WatchCall::wake() {
  {
    const std::lock_guard lock(mutex_);
    if (phase_ != Phase::kResting) {
      news_ = true;
      return;
    }
    phase_ = Phase::kReading;
  }
  read_later();
}

void WatchCall::stop(const absl::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    if (!stop_) stop_ = status;
    if (phase_ != Phase::kResting) return;  // who acts now sees stop_
    phase_ = Phase::kReading;
  }
  end(status);
}

void WatchCall::server_stops() {
  stop(absl::UnavailableError("the server stops; watch again from the last sequence"));
}

void WatchCall::OnCancel() { stop(absl::CancelledError("the client hung up")); }

bool WatchCall::stopped() {
  std::optional<absl::Status> status;
  {
    const std::lock_guard lock(mutex_);
    status = stop_;
  }
  if (status) end(*status);
  return status.has_value();
}

void WatchCall::end(const absl::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    phase_ = Phase::kEnded;
  }
  parts_.hub.unsubscribe(job_id_, this);
  Finish(to_grpc(status, job_id_));
}

void WatchCall::OnDone() {
  std::shared_ptr<WatchCall> last;
  const std::lock_guard lock(mutex_);
  last.swap(self_);  // gone after the lock, unless a wake still holds the call
}

}  // namespace skinframe::server
