// SPDX-License-Identifier: Apache-2.0
#include "server/leases/lease_reaper.h"

#include <algorithm>

#include "server/jobs/decisions.h"

namespace skinframe::server {
namespace {
constexpr int kMostAtOnce = 100;
}

LeaseReaper::LeaseReaper(JobStore& store, const AttemptPolicy& policy, Time server_start)
    : store_(store), policy_(policy), patient_until_(server_start + policy.lease) {}

absl::Status LeaseReaper::run_once(Time now) {
  patient_until_ = std::min(patient_until_, now + policy_.lease);  // the clock may have been set back
  if (now < patient_until_) return absl::OkStatus();
  const auto expired = store_.expired_leases(now, kMostAtOnce);
  if (!expired.ok()) return expired.status();
  return sweep_.run(store_, *expired,
                    [&](const JobRecord& record) { return decide_lease_expired(record, now, policy_); });
}

}  // namespace skinframe::server
