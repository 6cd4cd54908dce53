// SPDX-License-Identifier: Apache-2.0
#include "server/replicas/progress_follower.h"

#include <utility>

namespace skinframe::server {

absl::Status ProgressFollower::run_once(Time now) {
  // A clock that was set back must not silence the follower.
  if (now >= looked_ && now - looked_ < every_) return absl::OkStatus();
  looked_ = now;
  const std::vector<std::string> watched = hub_.watched_jobs();
  if (watched.empty()) {
    seen_.clear();
    return absl::OkStatus();
  }
  auto newest = store_.last_sequences(watched);
  if (!newest.ok()) return newest.status();
  for (const auto& [job_id, sequence] : *newest) {
    const auto before = seen_.find(job_id);
    if (before == seen_.end() || before->second != sequence) hub_.wake(job_id);
  }
  seen_ = *std::move(newest);
  return absl::OkStatus();
}

}  // namespace skinframe::server
