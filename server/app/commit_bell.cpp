// SPDX-License-Identifier: Apache-2.0
#include "server/app/commit_bell.h"

#include <spdlog/spdlog.h>

#include "server/jobs/transitions.h"

namespace skinframe::server {
namespace {

void log_state(const JobRecord& record) {
  const v1::Job& job = record.job;
  switch (job.state()) {
    case v1::JOB_STATE_RUNNING:
      spdlog::info("job={} state=RUNNING attempt={} token={} worker={}", job.job_id(), job.attempt(),
                   record.lease.fencing_token, record.lease.worker_id);
      break;
    case v1::JOB_STATE_QUEUED:
      spdlog::info("job={} state=QUEUED attempt={} {}", job.job_id(), job.attempt(), job.detail());
      break;
    default:
      spdlog::info("job={} state={} reason={} attempt={} {}", job.job_id(), state_name(job.state()),
                   reason_name(job.reason()), job.attempt(), job.detail());
  }
}

}  // namespace

void CommitBell::committed(const JobRecord& record, bool state_changed) {
  hub_.wake(record.job.job_id());
  if (!state_changed) return;
  log_state(record);
  counts_.state_changed(record.job);
  if (record.job.state() == v1::JOB_STATE_QUEUED) offer();
}

void CommitBell::offer() {
  if (LeaseDesk* desk = desk_; desk != nullptr) desk->job_queued();
}

void CommitBell::changed_elsewhere(const std::string& job_id, bool queued) {
  hub_.wake(job_id);
  if (queued) offer();
}

void CommitBell::missed_news() {
  hub_.wake_all();
  offer();
}

void CommitBell::removed(const std::string& job_id) {
  spdlog::info("job={} deleted", job_id);
  hub_.wake(job_id);  // a watcher that was still reading finds it gone
}

}  // namespace skinframe::server
