// SPDX-License-Identifier: Apache-2.0
// Where jobs and their events live. The store decides nothing: it runs the caller's decision inside a
// transaction and makes record and events durable together.
//
// Guarantees of every implementation, checked by one conformance suite:
//   1. A write that returned OK is durable; one that returned an error left nothing behind.
//   2. A decision sees the job as it stands, and nothing changes the job between that look and its change.
//   3. A job's events are numbered 1, 2, 3 ... without a gap, in the order of their commits; thin_progress
//   alone
//      leaves gaps.
//   4. After a commit, and before the write returns, the listener is told.
//   5. Fencing tokens rise over all jobs, and none is given twice, whatever was deleted or restarted.
// All calls block; all may be made from any thread. Errors beside those named: UNAVAILABLE (busy, stopping),
// RESOURCE_EXHAUSTED (disk full), INTERNAL (damaged).
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/jobs/job_record.h"

namespace skinframe::server {

// Told on the committing thread: must be quick, and must not call the store.
class CommitListener {
 public:
  virtual ~CommitListener() = default;
  virtual void committed(const JobRecord& record, bool state_changed) = 0;
  virtual void removed(const std::string& job_id) = 0;

  // What another server on the same store did, where several share it: a change of state or a removal. What
  // is no change of state is not told (see JobStore::last_sequences).
  virtual void changed_elsewhere(const std::string& /*job_id*/, bool /*queued*/) {}
  // Anything may have changed elsewhere: news were lost while the store was out of reach.
  virtual void missed_news() {}
};

struct Created {
  JobRecord record;
  bool existed = false;  // the request id was known with the same spec digest; nothing was written
};

// How many jobs may be queued; RESOURCE_EXHAUSTED beyond either.
struct QueueLimits {
  QueueLimits(std::int64_t all_jobs,  // NOLINT(google-explicit-constructor)
              std::int64_t jobs_of_the_tenant = std::numeric_limits<std::int64_t>::max())
      : all(all_jobs), of_tenant(jobs_of_the_tenant) {}
  std::int64_t all;        // over all tenants
  std::int64_t of_tenant;  // of the job's own
};

// An artifact that was a job's checkpoint: replaced by a newer one, or the job has ended.
struct DroppedCheckpoint {
  std::string tenant;
  std::string sha256;
  auto operator<=>(const DroppedCheckpoint&) const = default;
};

// A tenant that has queued jobs, and how many of its jobs are running.
struct TenantLoad {
  std::string tenant;
  std::int64_t running = 0;
};

// What a tenant has that has not ended.
struct TenantFigures {
  std::string tenant;
  std::int64_t queued = 0;
  std::int64_t running = 0;
  std::optional<Time> oldest_queued;  // when the queued job that was submitted first was submitted
};

struct ListQuery {
  std::optional<std::string> tenant;          // none: of all
  std::vector<v1::JobState> states;           // empty: all
  std::map<std::string, std::string> labels;  // all must match
  int limit = 50;
  std::int64_t before_ordinal = 0;  // from a page before; 0: from the newest
};

struct ListPage {
  struct Entry {
    v1::Job job;
    std::int64_t ordinal;  // of submission: where the next page begins
    std::vector<v1::ResultFile>
        warm_start_files;  // that the job starts from; of an earlier one, perhaps deleted
  };
  std::vector<Entry> entries;  // newest first
  bool more = false;
};

// The change to make, nothing, or a refusal, which becomes the call's own status.
using Decide = std::function<absl::StatusOr<std::optional<Change>>(const JobRecord&)>;
// Whose jobs to look at, in this order; those left out get nothing.
using OrderTenants = std::function<std::vector<std::string>(const std::vector<TenantLoad>&)>;
using DecideLease = std::function<Change(const JobRecord&, std::int64_t fencing_token)>;
using Permit = std::function<absl::Status(const JobRecord&)>;

inline std::vector<std::string> all_by_name(const std::vector<TenantLoad>& waiting) {
  std::vector<std::string> names;
  for (const TenantLoad& load : waiting) names.push_back(load.tenant);
  return names;  // the store names them so
}

class JobStore {
 public:
  virtual ~JobStore() = default;

  // ALREADY_EXISTS: the request id is known, of the same tenant, with another digest. RESOURCE_EXHAUSTED: as
  // many jobs are queued as may be; only asked of a job that is to be queued.
  virtual absl::StatusOr<Created> create(const Change& job, const QueueLimits& limits) = 0;

  // Runs decide on the job and makes its change durable; returns the job as it then stands. NOT_FOUND.
  virtual absl::StatusOr<JobRecord> modify(const std::string& job_id, const Decide& decide) = 0;

  // Runs decide on the first queued job with not_before <= now of the first tenant in the order that has one:
  // smallest rank_ms, then oldest. Nothing: no such job. Costs the same however many jobs are queued.
  virtual absl::StatusOr<std::optional<JobRecord>> lease_next(Time now, const OrderTenants& order,
                                                              const DecideLease& decide) = 0;
  // The same for those who have no policy between tenants: in the order of their names.
  absl::StatusOr<std::optional<JobRecord>> lease_next(Time now, const DecideLease& decide) {
    return lease_next(now, all_by_name, decide);
  }

  // Forgets job, labels and events when permit says OK. NOT_FOUND.
  virtual absl::Status remove(const std::string& job_id, const Permit& permit) = 0;

  // NOT_FOUND.
  virtual absl::StatusOr<JobRecord> get(const std::string& job_id) = 0;
  virtual absl::StatusOr<ListPage> list(const ListQuery& query) = 0;

  // The newest job of the tenant that SUCCEEDED without reservation and has this reuse_key; nothing: none.
  virtual absl::StatusOr<std::optional<JobRecord>> find_reusable(const std::string& tenant,
                                                                 const std::string& reuse_key) = 0;

  // At most limit events after a sequence number, in order; thinned ones are not among them. NOT_FOUND.
  virtual absl::StatusOr<std::vector<v1::JobEvent>> events(const std::string& job_id,
                                                           std::int64_t after_sequence, int limit) = 0;

  // Queued jobs of its tenant that stand before this queued one; counts to 1000 and no further. NOT_FOUND.
  virtual absl::StatusOr<std::int64_t> queued_before(const std::string& job_id) = 0;

  // Ids of running jobs whose lease ended at or before now; of queued jobs whose deadline passed. Oldest
  // first.
  virtual absl::StatusOr<std::vector<std::string>> expired_leases(Time now, int limit) = 0;
  virtual absl::StatusOr<std::vector<std::string>> passed_deadlines(Time now, int limit) = 0;

  // Ids of jobs that ended at or before a time, those that ended first first.
  virtual absl::StatusOr<std::vector<std::string>> ended_jobs(Time until, int limit) = 0;

  // Forgets the progress events of at most so many jobs that ended at or before a time; how many jobs.
  // Changes of state and results of printers stay, under their numbers.
  virtual absl::StatusOr<int> thin_progress(Time until, int most_jobs) = 0;

  // Checkpoints that modify() has taken from their jobs, until they are forgotten here. The file may be in
  // use all the same: another job may have come to the same one. Each is told once however often it was
  // dropped.
  virtual absl::StatusOr<std::vector<DroppedCheckpoint>> dropped_checkpoints(int limit) = 0;
  virtual absl::Status forget_dropped(const std::vector<DroppedCheckpoint>& seen_to) = 0;

  // Of each tenant that has jobs queued or running, by name. Costs a walk over the index of those jobs: for a
  // look now and then, not for each call.
  virtual absl::StatusOr<std::vector<TenantFigures>> tenant_figures() = 0;

  // The sequence number of the newest event of each of these jobs; unknown ones are left out.
  virtual absl::StatusOr<std::map<std::string, std::int64_t>> last_sequences(
      const std::vector<std::string>& job_ids) = 0;
};

}  // namespace skinframe::server
