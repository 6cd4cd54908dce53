// SPDX-License-Identifier: Apache-2.0
#include "server/leases/deadline_watch.h"

#include "server/jobs/decisions.h"

namespace skinframe::server {
namespace {
constexpr int kMostAtOnce = 100;
}

absl::Status DeadlineWatch::run_once(Time now) {
  const auto passed = store_.passed_deadlines(now, kMostAtOnce);
  if (!passed.ok()) return passed.status();
  for (const std::string& job_id : *passed) {
    const auto after =
        store_.modify(job_id, [&](const JobRecord& record) { return decide_deadline(record, now); });
    if (!after.ok() && !absl::IsNotFound(after.status())) return after.status();
  }
  return absl::OkStatus();
}

}  // namespace skinframe::server
