// SPDX-License-Identifier: Apache-2.0
// Where workers wait for work (the long poll of WorkerService.Lease). First come, first served among workers,
// fair among tenants; a job that becomes queued reaches the first waiting worker at once.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/executor/executor.h"
#include "server/jobs/attempt_policy.h"
#include "server/leases/duty.h"
#include "server/leases/fair_share.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class LeaseDesk final : public Duty {
 public:
  // The job, running, with its new token; nothing when the wait is over; UNAVAILABLE when the server stops;
  // CANCELLED after withdraw.
  using Answer = std::function<void(absl::StatusOr<std::optional<JobRecord>>)>;
  using Ticket = std::uint64_t;

  // The executor is stopped before the desk goes.
  LeaseDesk(JobStore& store, Executor& executor, const Clock& clock, const AttemptPolicy& policy,
            const TenantDirectory& tenants);

  // Calls answer exactly once, on a thread of the executor or of the caller of run_once, withdraw or close;
  // never from within ask.
  Ticket ask(const std::string& worker_id, const std::string& instance_id, Milliseconds wait, Answer answer);

  // The worker hung up. A job that is just being given to it is queued again.
  void withdraw(Ticket ticket);

  // The answer with this job came too late: the worker had hung up. Queues the job again, if it is still its.
  void undelivered(const JobRecord& leased);

  std::size_t waiting();  // workers, with the one that is being looked for

  // Quick, and calls no store: for the store's listener.
  void job_queued();

  // Ends waits that are over, and looks for jobs whose backoff has passed.
  std::string_view name() const override { return "lease desk"; }
  absl::Status run_once(Time now) override;

  void close();

 private:
  struct Waiter {
    Ticket ticket;
    std::string worker_id;
    std::string instance_id;
    Time until;
    Answer answer;
  };

  bool take_from_hand(Ticket ticket);
  void schedule_serve();
  void serve();
  void answer_overdue(Time now);
  std::optional<Waiter> take_first();

  JobStore& store_;
  Executor& executor_;
  const Clock& clock_;
  const AttemptPolicy policy_;
  FairShare fair_share_;  // only whoever serves
  std::mutex mutex_;
  std::list<Waiter> waiters_;  // by arrival
  Ticket last_ticket_ = 0;
  Ticket in_hand_ =
      0;  // the waiter for whom the store is being asked; 0: none, or it was withdrawn meanwhile
  bool serving_ = false;  // one server of the queue at a time keeps the order
  bool again_ = false;    // something was queued meanwhile
  bool closed_ = false;
};

}  // namespace skinframe::server
