// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/job_counts.h"

#include <string>

#include "server/jobs/transitions.h"

namespace skinframe::server {
namespace {

prometheus::Family<prometheus::Counter>& counter(prometheus::Registry& registry, const char* name,
                                                 const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

}  // namespace

JobCounts::JobCounts(prometheus::Registry& registry)
    : submitted_(
          counter(registry, "skinframe_jobs_submitted_total", "Jobs made, reused ones included").Add({})),
      attempts_(counter(registry, "skinframe_attempts_total", "Jobs given to a worker").Add({})),
      requeued_(counter(registry, "skinframe_requeued_total",
                        "Attempts after which the job was queued again: lost, or handed back")
                    .Add({})),
      ended_(counter(registry, "skinframe_jobs_ended_total", "Jobs that have ended, by state and reason")) {}

void JobCounts::state_changed(const v1::Job& job) {
  if (job.attempt() == 0 && (job.state() == v1::JOB_STATE_QUEUED || !job.reused_job_id().empty()))
    submitted_.Increment();
  if (job.state() == v1::JOB_STATE_RUNNING) attempts_.Increment();
  if (job.state() == v1::JOB_STATE_QUEUED && job.attempt() > 0) requeued_.Increment();
  if (is_final(job.state())) {
    ended_
        .Add({{"state", std::string(state_name(job.state()))},
              {"reason", std::string(reason_name(job.reason()))}})
        .Increment();
  }
}

}  // namespace skinframe::server
