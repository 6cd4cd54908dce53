// SPDX-License-Identifier: Apache-2.0
// Forgets the progress of jobs some time after they have ended: an hour's work is ten thousand events that
// nobody reads again. Changes of state and results of printers stay for as long as the job.
#pragma once

#include "server/leases/duty.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class ProgressThinning final : public Duty {
 public:
  // keep > 0: for so long after a job's end its progress is kept. Looks when `every` has passed since the
  // last look.
  ProgressThinning(JobStore& store, Milliseconds keep, Milliseconds every)
      : store_(store), keep_(keep), every_(every) {}
  std::string_view name() const override { return "progress thinning"; }
  absl::Status run_once(Time now) override;

 private:
  JobStore& store_;
  const Milliseconds keep_;
  const Milliseconds every_;
  Time looked_{};
};

}  // namespace skinframe::server
