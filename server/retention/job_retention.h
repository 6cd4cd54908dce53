// SPDX-License-Identifier: Apache-2.0
// Forgets jobs some time after they have ended. Their results stay until the artifact cleaner finds that
// nobody refers to them any more.
#pragma once

#include "server/retention/aged_sweep.h"

namespace skinframe::server {

class JobRetention final : public AgedSweep {
 public:
  using AgedSweep::AgedSweep;
  std::string_view name() const override { return "job retention"; }

 private:
  absl::StatusOr<bool> sweep(JobStore& store, Time ended_before) override;
};

}  // namespace skinframe::server
