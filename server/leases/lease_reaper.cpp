// SPDX-License-Identifier: Apache-2.0
#include "server/leases/lease_reaper.h"

#include "server/jobs/decisions.h"

namespace skinframe::server {
namespace {
constexpr int kMostAtOnce = 100;
}

LeaseReaper::LeaseReaper(JobStore& store, const AttemptPolicy& policy, Time server_start)
    : store_(store), policy_(policy), patient_until_(server_start + policy.lease) {}

absl::Status LeaseReaper::run_once(Time now) {
  if (now < patient_until_) return absl::OkStatus();
  const auto expired = store_.expired_leases(now, kMostAtOnce);
  if (!expired.ok()) return expired.status();
  for (const std::string& job_id : *expired) {
    const auto after = store_.modify(
        job_id, [&](const JobRecord& record) { return decide_lease_expired(record, now, policy_); });
    if (!after.ok() && !absl::IsNotFound(after.status())) return after.status();
  }
  return absl::OkStatus();
}

}  // namespace skinframe::server
