// SPDX-License-Identifier: Apache-2.0
// Takes jobs back whose worker has fallen silent.
#pragma once

#include "server/jobs/attempt_policy.h"
#include "server/leases/duty.h"
#include "server/leases/job_sweep.h"
#include "server/store/job_store.h"

namespace skinframe::server {

// For one lease's time after the start nothing is taken: while the server was away no heartbeat could come,
// and the workers get the chance to send theirs. A lease stays good until it is taken, also when its time is
// over.
class LeaseReaper final : public Duty {
 public:
  LeaseReaper(JobStore& store, const AttemptPolicy& policy, Time server_start);
  std::string_view name() const override { return "lease reaper"; }
  absl::Status run_once(Time now) override;

  std::uint64_t expiries() const { return sweep_.changes(); }  // leases that it has ended; from any thread

 private:
  JobStore& store_;
  const AttemptPolicy policy_;
  Time patient_until_;
  JobSweep sweep_{name()};
};

}  // namespace skinframe::server
