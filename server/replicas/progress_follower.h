// SPDX-License-Identifier: Apache-2.0
// Where several servers share a store, a worker may report to another server than the one that a watcher
// asked. Changes of state are told from server to server; progress is not, it would be too much. So the jobs
// that are watched here are looked at now and then, all of them in one query, and the watchers of those that
// have news are woken.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "server/events/watch_hub.h"
#include "server/leases/duty.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class ProgressFollower final : public Duty {
 public:
  // Looks when `every` has passed since the last look.
  ProgressFollower(JobStore& store, WatchHub& hub, Milliseconds every)
      : store_(store), hub_(hub), every_(every) {}
  std::string_view name() const override { return "progress follower"; }
  absl::Status run_once(Time now) override;

 private:
  JobStore& store_;
  WatchHub& hub_;
  const Milliseconds every_;
  Time looked_{};
  std::map<std::string, std::int64_t> seen_;  // of the watched jobs
};

}  // namespace skinframe::server
