// SPDX-License-Identifier: Apache-2.0
// Forgets the progress of jobs some time after they have ended: an hour's work is ten thousand events that
// nobody reads again. Changes of state and results of printers stay for as long as the job.
#pragma once

#include "server/retention/aged_sweep.h"

namespace skinframe::server {

class ProgressThinning final : public AgedSweep {
 public:
  using AgedSweep::AgedSweep;
  std::string_view name() const override { return "progress thinning"; }

 private:
  absl::StatusOr<bool> sweep(JobStore& store, Time ended_before) override;
};

}  // namespace skinframe::server
