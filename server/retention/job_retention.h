// SPDX-License-Identifier: Apache-2.0
// Forgets jobs some time after they have ended. Their results stay until the artifact cleaner finds that
// nobody refers to them any more.
#pragma once

#include "server/leases/duty.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class JobRetention final : public Duty {
 public:
  // keep > 0: for so long after its end a job is kept. Looks when `every` has passed since the last look.
  JobRetention(JobStore& store, Milliseconds keep, Milliseconds every)
      : store_(store), keep_(keep), every_(every) {}
  std::string_view name() const override { return "job retention"; }
  absl::Status run_once(Time now) override;

 private:
  JobStore& store_;
  const Milliseconds keep_;
  const Milliseconds every_;
  Time looked_{};
};

}  // namespace skinframe::server
