// SPDX-License-Identifier: Apache-2.0
// All that the server knows of one job: what clients see (v1::Job) and what only the server needs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/clock.h"
#include "skinframe/v1/catalog.pb.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::server {

// Whose jobs are those of callers of whom nothing else is known.
inline constexpr char kDefaultTenant[] = "default";

// Who runs the current attempt, or ran the last one. A token of 0 means that there was none yet.
struct Lease {
  std::int64_t fencing_token = 0;  // unique over all attempts of all jobs, never given twice
  std::string worker_id;
  std::string instance_id;
  Time expires{};
};

// Invariants, kept by decisions.cpp:
//   1. job.state is RUNNING exactly while lease is someone's; afterwards lease tells who had it last.
//   2. printers and materials have one entry for each of job.spec().printers(), in order: copies taken at
//      submission, so that the job means the same after a profile has changed.
//   3. lost_attempts <= job.attempt.
//   4. job.tenant names whose job it is, and never changes.
struct JobRecord {
  v1::Job job;
  std::string request_id;   // empty: none; the tenant's own
  std::string spec_digest;  // SHA-256 of the canonical spec; tells a repeated request from another one
  std::string reuse_key;    // the same for jobs that must come to the same result; empty: not to be compared
  std::int64_t rank_ms =
      0;  // the place in the tenant's queue, smaller first: see rank_ms() in attempt_policy.h
  std::vector<v1::PrinterProfile> printers;
  std::vector<v1::MaterialProfile> materials;
  std::vector<v1::ResultFile> warm_start_files;  // of spec.warm_start_job_id, copied at submission
  std::optional<Time> deadline;
  Time not_before{};      // a queued job is not leased earlier: the backoff after a lost attempt
  int lost_attempts = 0;  // attempts that ended without a result
  Lease lease;
  std::string completion_digest;  // of the last accepted completion: tells its repetition from another one
};

// A record as it shall be, and the events that tell of it. The store numbers the events and writes both in
// one transaction.
struct Change {
  JobRecord record;
  std::vector<v1::JobEvent> events;  // time and body set; job_id and sequence are the store's
};

}  // namespace skinframe::server
