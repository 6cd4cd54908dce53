// SPDX-License-Identifier: Apache-2.0
// Ends queued jobs whose deadline has passed. Running ones end through heartbeat and lease: see decisions.h.
#pragma once

#include "server/leases/duty.h"
#include "server/leases/job_sweep.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class DeadlineWatch final : public Duty {
 public:
  explicit DeadlineWatch(JobStore& store) : store_(store) {}
  std::string_view name() const override { return "deadline watch"; }
  absl::Status run_once(Time now) override;

 private:
  JobStore& store_;
  JobSweep sweep_{name()};
};

}  // namespace skinframe::server
