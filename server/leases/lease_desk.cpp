// SPDX-License-Identifier: Apache-2.0
#include "server/leases/lease_desk.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <utility>

#include "server/jobs/decisions.h"

namespace skinframe::server {
namespace {

absl::Status server_stops() { return absl::UnavailableError("the server stops; ask again with backoff"); }

}  // namespace

LeaseDesk::LeaseDesk(JobStore& store, Executor& executor, const Clock& clock, const AttemptPolicy& policy,
                     const TenantDirectory& tenants)
    : store_(store), executor_(executor), clock_(clock), policy_(policy), fair_share_(tenants) {}

LeaseDesk::Ticket LeaseDesk::ask(const std::string& worker_id, const std::string& instance_id,
                                 Milliseconds wait, Answer answer) {
  const Milliseconds bounded = std::clamp(wait, Milliseconds(0), policy_.longest_wait);
  const std::lock_guard lock(mutex_);
  const Ticket ticket = ++last_ticket_;
  if (closed_) {
    executor_.post([answer = std::move(answer)] { answer(server_stops()); });
    return ticket;
  }
  waiters_.push_back({ticket, worker_id, instance_id, clock_.now() + bounded, std::move(answer)});
  schedule_serve();
  return ticket;
}

void LeaseDesk::withdraw(Ticket ticket) {
  std::optional<Waiter> gone;
  {
    const std::lock_guard lock(mutex_);
    if (ticket == in_hand_) in_hand_ = 0;  // serve() sees it
    const auto at =
        std::find_if(waiters_.begin(), waiters_.end(), [&](const Waiter& w) { return w.ticket == ticket; });
    if (at == waiters_.end()) return;
    gone = std::move(*at);
    waiters_.erase(at);
  }
  gone->answer(absl::CancelledError("the worker hung up"));
}

std::size_t LeaseDesk::waiting() {
  const std::lock_guard lock(mutex_);
  return waiters_.size() + (in_hand_ != 0 ? 1 : 0);
}

void LeaseDesk::job_queued() {
  const std::lock_guard lock(mutex_);
  // While one is being served the list may be empty, and that one may have looked too early for this job.
  if (serving_ || !waiters_.empty()) schedule_serve();
}

// With mutex_ held.
void LeaseDesk::schedule_serve() {
  if (serving_) {
    again_ = true;
    return;
  }
  serving_ = true;
  executor_.post([this] { serve(); });
}

// Whether the waiter is still there.
bool LeaseDesk::take_from_hand(Ticket ticket) {
  const std::lock_guard lock(mutex_);
  return std::exchange(in_hand_, 0) == ticket;
}

void LeaseDesk::undelivered(const JobRecord& leased) {
  const auto queued = store_.modify(leased.job.job_id(), [&](const JobRecord& record) {
    return decide_undelivered(record, leased.lease.fencing_token, clock_.now());
  });
  // The lease's end does the same later.
  if (!queued.ok())
    spdlog::warn("job={} stays with a worker that hung up until its lease ends: {}", leased.job.job_id(),
                 std::string(queued.status().message()));
}

std::optional<LeaseDesk::Waiter> LeaseDesk::take_first() {
  const std::lock_guard lock(mutex_);
  if (waiters_.empty()) return std::nullopt;
  Waiter first = std::move(waiters_.front());
  waiters_.pop_front();
  in_hand_ = first.ticket;
  return first;
}

void LeaseDesk::serve() {
  for (;;) {
    std::optional<Waiter> waiter = take_first();
    if (waiter) {
      const Time now = clock_.now();
      auto leased = store_.lease_next(
          now, [&](const std::vector<TenantLoad>& waiting) { return fair_share_.order(waiting); },
          [&](const JobRecord& record, std::int64_t token) {
            return decide_lease(record, token, waiter->worker_id, waiter->instance_id, now, policy_);
          });
      const bool nothing_to_do = leased.ok() && !leased->has_value();
      if (!nothing_to_do) {
        if (leased.ok()) fair_share_.leased((*leased)->job.tenant());
        const bool gone = !take_from_hand(waiter->ticket);
        if (gone && leased.ok()) {
          undelivered(**leased);
          leased = absl::CancelledError("the worker hung up");
        }
        waiter->answer(std::move(leased));
        continue;
      }
    }
    // Nothing to do for this one, hence for none behind it.
    std::unique_lock lock(mutex_);
    const bool stopped = closed_;
    const bool withdrawn = waiter && in_hand_ != waiter->ticket;
    in_hand_ = 0;
    if (waiter && !stopped && !withdrawn) {
      waiters_.push_front(*std::move(waiter));
      waiter.reset();
    }
    const bool look_again = std::exchange(again_, false) && !waiters_.empty();
    if (!look_again) serving_ = false;
    lock.unlock();
    if (waiter) waiter->answer(stopped ? server_stops() : absl::CancelledError("the worker hung up"));
    if (!look_again) break;
  }
  answer_overdue(clock_.now());  // a wait of zero ends with the first look
}

void LeaseDesk::answer_overdue(Time now) {
  std::list<Waiter> over;
  {
    const std::lock_guard lock(mutex_);
    if (serving_) return;  // a new waiter may not have had its look yet; serve() comes here at its end
    for (auto at = waiters_.begin(); at != waiters_.end();) {
      const auto next = std::next(at);
      if (at->until <= now) over.splice(over.end(), waiters_, at);
      at = next;
    }
  }
  for (Waiter& waiter : over) waiter.answer(std::optional<JobRecord>());
}

absl::Status LeaseDesk::run_once(Time now) {
  answer_overdue(now);
  job_queued();  // a backoff may have passed
  return absl::OkStatus();
}

void LeaseDesk::close() {
  std::list<Waiter> all;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    all.swap(waiters_);
  }
  for (Waiter& waiter : all) waiter.answer(server_stops());
}

}  // namespace skinframe::server
