// SPDX-License-Identifier: Apache-2.0
// One decision for each of many jobs, so that a job that cannot be changed (its row is damaged, say) does not
// hold up the others.
#pragma once

#include <atomic>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/job_store.h"

namespace skinframe::server {

class JobSweep {
 public:
  explicit JobSweep(std::string_view duty) : duty_(duty) {}

  // A job that fails is logged with its id, once until it comes through or is no longer in the list, and
  // passed over; one that is gone is nothing. UNAVAILABLE and RESOURCE_EXHAUSTED are the store's own state,
  // not the job's: they end the sweep and are returned.
  absl::Status run(JobStore& store, const std::vector<std::string>& job_ids, const Decide& decide);

  std::uint64_t changes() const { return changes_; }  // made since the start; from any thread

 private:
  const std::string_view duty_;
  std::atomic<std::uint64_t> changes_ = 0;
  std::set<std::string> failed_;  // in the sweep before
};

}  // namespace skinframe::server
