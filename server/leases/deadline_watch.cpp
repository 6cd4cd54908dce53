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
  return sweep_.run(store_, *passed, [&](const JobRecord& record) { return decide_deadline(record, now); });
}

}  // namespace skinframe::server
