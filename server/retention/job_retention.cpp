// SPDX-License-Identifier: Apache-2.0
#include "server/retention/job_retention.h"

#include "server/jobs/decisions.h"

namespace skinframe::server {
namespace {
constexpr int kMostAtOnce = 100;  // other duties have their turn in between
}

absl::Status JobRetention::run_once(Time now) {
  if (now >= looked_ && now - looked_ < every_) return absl::OkStatus();
  const auto ended = store_.ended_jobs(now - keep_, kMostAtOnce);
  if (!ended.ok()) return ended.status();
  for (const std::string& job_id : *ended) {
    const absl::Status status = store_.remove(job_id, permit_delete);
    if (!status.ok() && !absl::IsNotFound(status)) return status;
  }
  if (ended->size() < kMostAtOnce) looked_ = now;  // else the rest has its turn in the next round
  return absl::OkStatus();
}

}  // namespace skinframe::server
