// SPDX-License-Identifier: Apache-2.0
#include "server/retention/job_retention.h"

#include "server/jobs/decisions.h"

namespace skinframe::server {
namespace {
constexpr int kMostAtOnce = 100;  // other duties have their turn in between
}

absl::StatusOr<bool> JobRetention::sweep(JobStore& store, Time ended_before) {
  const auto ended = store.ended_jobs(ended_before, kMostAtOnce);
  if (!ended.ok()) return ended.status();
  for (const std::string& job_id : *ended) {
    const absl::Status status = store.remove(job_id, permit_delete);
    if (!status.ok() && !absl::IsNotFound(status)) return status;
  }
  return ended->size() < kMostAtOnce;
}

}  // namespace skinframe::server
