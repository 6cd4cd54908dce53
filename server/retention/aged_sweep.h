// SPDX-License-Identifier: Apache-2.0
// A duty that clears away what has been there for some time, a batch a round, and looks again when a period
// has passed since it found no more.
#pragma once

#include "absl/status/statusor.h"
#include "server/leases/duty.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class AgedSweep : public Duty {
 public:
  // keep > 0: for so long after a job's end nothing of it goes.
  AgedSweep(JobStore& store, Milliseconds keep, Milliseconds every)
      : store_(store), keep_(keep), every_(every) {}

  absl::Status run_once(Time now) final {
    if (now >= looked_ && now - looked_ < every_) return absl::OkStatus();
    const auto done = sweep(store_, now - keep_);
    if (done.ok() && *done) looked_ = now;  // else the rest has its turn in the next round
    return done.status();
  }

 private:
  // A batch of what ended before then; true: that was all.
  virtual absl::StatusOr<bool> sweep(JobStore& store, Time ended_before) = 0;

  JobStore& store_;
  const Milliseconds keep_;
  const Milliseconds every_;
  Time looked_{};
};

}  // namespace skinframe::server
