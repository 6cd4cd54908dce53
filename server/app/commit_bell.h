// SPDX-License-Identifier: Apache-2.0
// Passes on what was committed: wakes the job's watchers and waiting workers, and counts and logs each change
// of state.
#pragma once

#include <atomic>

#include "server/events/watch_hub.h"
#include "server/leases/lease_desk.h"
#include "server/metrics/job_counts.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class CommitBell final : public CommitListener {
 public:
  CommitBell(WatchHub& hub, JobCounts& counts) : hub_(hub), counts_(counts) {}

  // The desk needs the store, and the store this bell: so the desk comes last.
  void connect(LeaseDesk* desk) { desk_ = desk; }

  void committed(const JobRecord& record, bool state_changed) override;
  void removed(const std::string& job_id) override;
  void changed_elsewhere(const std::string& job_id, bool queued) override;
  void missed_news() override;

 private:
  void offer();  // a job may be there for a waiting worker

  WatchHub& hub_;
  JobCounts& counts_;
  std::atomic<LeaseDesk*> desk_ = nullptr;
};

}  // namespace skinframe::server
