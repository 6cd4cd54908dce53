// SPDX-License-Identifier: Apache-2.0
#include "server/leases/job_sweep.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace skinframe::server {

absl::Status JobSweep::run(JobStore& store, const std::vector<std::string>& job_ids, const Decide& decide) {
  std::set<std::string> failed;
  for (const std::string& job_id : job_ids) {
    bool changes = false;
    const auto watched = [&](const JobRecord& record) {
      auto decision = decide(record);
      changes = decision.ok() && decision->has_value();
      return decision;
    };
    const absl::Status status = store.modify(job_id, watched).status();
    if (status.ok() && changes) ++changes_;
    if (status.ok() || absl::IsNotFound(status)) continue;
    if (absl::IsUnavailable(status) || absl::IsResourceExhausted(status)) return status;
    if (!failed_.contains(job_id)) {
      spdlog::error("job={} {}: {}", job_id, duty_, std::string(status.message()));
    }
    failed.insert(job_id);
  }
  failed_ = std::move(failed);
  return absl::OkStatus();
}

}  // namespace skinframe::server
