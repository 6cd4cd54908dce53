// SPDX-License-Identifier: Apache-2.0
// The statements behind each call of JobStore, the same for every SQL store; see job_rows.h for Database.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "server/store/job_rows.h"
#include "server/store/job_store.h"
#include "server/store/queue_counts.h"

namespace skinframe::server {

// The job that a request id made before. ALREADY_EXISTS: with another spec.
template <class Database>
absl::StatusOr<std::optional<JobRecord>> find_request(Database& database, const JobRecord& asked) {
  if (asked.request_id.empty()) return std::optional<JobRecord>();
  typename Database::Statement same(database,
                                    fmt::format("SELECT {} FROM jobs WHERE request_id = ?", kJobColumns));
  if (!same.bind_text(request_key(asked.job.tenant(), asked.request_id)).step()) {
    if (!same.status().ok()) return same.status();
    return std::optional<JobRecord>();
  }
  auto row = read_row(same);
  if (!row.ok()) return row.status();
  if (row->record.spec_digest != asked.spec_digest) {
    return absl::AlreadyExistsError(fmt::format("request_id \"{}\" was used with another spec, for job {}",
                                                asked.request_id, row->record.job.job_id()));
  }
  return std::optional<JobRecord>(std::move(row->record));
}

// counts: of the queue that database holds. RESOURCE_EXHAUSTED: one of the limits is reached.
template <class Database>
absl::StatusOr<Created> create_job(Database& database, const Change& job, const QueueLimits& limits,
                                   QueueCounts& counts) {
  for (;;) {
    auto same = find_request(database, job.record);
    if (!same.ok()) return same.status();
    if (same->has_value()) return Created{std::move(**same), true};
    const bool queued = job.record.job.state() == v1::JOB_STATE_QUEUED;
    if (queued) {
      absl::Status status = counts.permit_one_more(database, job.record.job.tenant(), limits);
      if (!status.ok()) return status;
    }
    Created created{job.record, false};
    const auto ordinal = insert_job(database, created.record);
    if (!ordinal.ok()) return ordinal.status();
    if (!ordinal->has_value()) continue;  // somebody came between the look and the insert
    if (absl::Status status = write_change(database, **ordinal, created.record, job.events); !status.ok())
      return status;
    if (queued) counts.add_one(job.record.job.tenant());
    return created;
  }
}

// The tenants that have queued jobs: by jumps through the index, so that it costs a look for each tenant and
// not for each job; and a count over the running jobs, which are as many as there are workers.
inline constexpr char kTenantLoads[] =
    "WITH RECURSIVE waiting (tenant) AS ("
    "SELECT min(tenant) FROM jobs WHERE state = 1 UNION ALL "
    "SELECT (SELECT min(tenant) FROM jobs WHERE state = 1 AND tenant > waiting.tenant) FROM waiting "
    "WHERE waiting.tenant IS NOT NULL) "
    "SELECT tenant, (SELECT count(*) FROM jobs WHERE state = 2 AND jobs.tenant = waiting.tenant) "
    "FROM waiting WHERE tenant IS NOT NULL";

template <class Database>
absl::StatusOr<std::vector<TenantLoad>> tenant_loads(Database& database) {
  typename Database::Statement select(database, kTenantLoads);
  std::vector<TenantLoad> loads;
  while (select.step()) loads.push_back({select.bytes(0), select.integer(1)});
  if (!select.status().ok()) return select.status();
  return loads;
}

// Parameters: a tenant, now.
template <class Database>
std::string first_queued_sql() {
  return fmt::format(
      "SELECT {} FROM jobs WHERE state = 1 AND tenant = ? AND not_before_ms <= ? ORDER BY rank_ms, ordinal "
      "LIMIT 1{}",
      kJobColumns, Database::kSkipLocked);
}

// The tenant's first job that may run now, locked where the store locks rows. Nothing: there is none, or
// others hold those that there are.
template <class Database>
absl::StatusOr<std::optional<JobRow>> first_queued(Database& database, const std::string& tenant, Time now) {
  typename Database::Statement first(database, first_queued_sql<Database>());
  if (first.bind_text(tenant).bind(to_ms(now)).step()) {
    auto row = read_row(first);
    if (!row.ok()) return row.status();
    return std::optional<JobRow>(*std::move(row));
  }
  if (!first.status().ok()) return first.status();
  return std::optional<JobRow>();
}

// The first job that may run now of the first tenant in the order that has one. asked: whose jobs were looked
// for, where that is wanted.
template <class Database>
absl::StatusOr<std::optional<JobRow>> first_in_order(Database& database, Time now, const OrderTenants& order,
                                                     std::vector<std::string>* asked = nullptr) {
  const auto loads = tenant_loads(database);
  if (!loads.ok()) return loads.status();
  std::vector<std::string> tenants = order(*loads);
  for (const std::string& tenant : tenants) {
    auto row = first_queued(database, tenant, now);
    if (!row.ok() || row->has_value()) return row;
  }
  if (asked != nullptr) *asked = std::move(tenants);
  return std::optional<JobRow>();
}

template <class Database>
absl::StatusOr<std::optional<JobRecord>> newest_reusable(Database& database, const std::string& tenant,
                                                         const std::string& reuse_key) {
  typename Database::Statement newest(
      database, fmt::format("SELECT {} FROM jobs WHERE state = 3 AND reason = 0 AND tenant = ? AND "
                            "reuse_key = ? ORDER BY ordinal DESC LIMIT 1",
                            kJobColumns));
  if (newest.bind_text(tenant).bind_text(reuse_key).step()) {
    auto row = read_row(newest);
    if (!row.ok()) return row.status();
    return std::optional<JobRecord>(std::move(row->record));
  }
  if (!newest.status().ok()) return newest.status();
  return std::optional<JobRecord>();
}

// Within the caller's transaction; how many jobs.
template <class Database>
absl::StatusOr<int> thin_ended_jobs(Database& database, Time until, int most_jobs) {
  std::vector<std::int64_t> ordinals;
  {
    typename Database::Statement ended(
        database, fmt::format("SELECT ordinal FROM jobs WHERE state > 2 AND thinned = 0 AND end_ms <= ? "
                              "ORDER BY end_ms LIMIT ?{}",
                              Database::kSkipLocked));
    ended.bind(to_ms(until)).bind(most_jobs);
    while (ended.step()) ordinals.push_back(ended.integer(0));
    if (!ended.status().ok()) return ended.status();
  }
  for (const std::int64_t ordinal : ordinals) {
    typename Database::Statement forget(database, "DELETE FROM events WHERE ordinal = ? AND progress = 1");
    if (absl::Status status = forget.bind(ordinal).run(); !status.ok()) return status;
    typename Database::Statement mark(database, "UPDATE jobs SET thinned = 1 WHERE ordinal = ?");
    if (absl::Status status = mark.bind(ordinal).run(); !status.ok()) return status;
  }
  return static_cast<int>(ordinals.size());
}

template <class Database>
absl::StatusOr<ListPage> list_jobs(Database& database, const ListQuery& query) {
  std::string sql = fmt::format("SELECT {} FROM jobs WHERE true", kJobColumns);
  if (query.tenant) sql += " AND tenant = ?";
  if (query.before_ordinal > 0) sql += " AND ordinal < ?";
  for (std::size_t i = 0; i < query.states.size(); ++i) sql += i == 0 ? " AND state IN (?" : ", ?";
  if (!query.states.empty()) sql += ")";
  for (std::size_t i = 0; i < query.labels.size(); ++i) {
    sql += " AND EXISTS (SELECT 1 FROM labels WHERE labels.ordinal = jobs.ordinal AND key = ? AND value = ?)";
  }
  sql += " ORDER BY ordinal DESC LIMIT ?";

  typename Database::Statement select(database, sql);
  if (query.tenant) select.bind_text(*query.tenant);
  if (query.before_ordinal > 0) select.bind(query.before_ordinal);
  for (const v1::JobState state : query.states) select.bind(state);
  for (const auto& [key, value] : query.labels) select.bind_text(key).bind_text(value);
  select.bind(query.limit + 1);  // one more tells whether there is a further page
  ListPage page;
  while (select.step()) {
    if (static_cast<int>(page.entries.size()) == query.limit) {
      page.more = true;
      break;
    }
    auto row = read_row(select);
    if (!row.ok()) return row.status();
    page.entries.push_back(
        {std::move(row->record.job), row->ordinal, std::move(row->record.warm_start_files)});
  }
  if (!select.status().ok()) return select.status();
  return page;
}

template <class Database>
absl::StatusOr<std::vector<v1::JobEvent>> read_events(Database& database, const std::string& job_id,
                                                      std::int64_t after_sequence, int limit) {
  // The job itself comes along as a row without a body, so that an unknown job is told from one without news.
  typename Database::Statement select(
      database,
      "SELECT body FROM jobs LEFT JOIN events ON events.ordinal = jobs.ordinal AND sequence > ? "
      "WHERE job_id = ? ORDER BY sequence LIMIT ?");
  select.bind(after_sequence).bind_text(job_id).bind(limit);
  std::vector<v1::JobEvent> events;
  bool job_there = false;
  while (select.step()) {
    job_there = true;
    if (select.is_null(0)) break;
    if (!events.emplace_back().ParseFromString(select.bytes(0))) {
      return absl::InternalError(fmt::format("store: an event of job {} does not parse: damaged", job_id));
    }
  }
  if (!select.status().ok()) return select.status();
  if (!job_there) return job_not_found(job_id);
  return events;
}

template <class Database>
absl::StatusOr<std::int64_t> count_queued_before(Database& database, const std::string& job_id) {
  typename Database::Statement count(
      database,
      "SELECT (SELECT count(*) FROM (SELECT 1 FROM jobs WHERE state = 1 AND tenant = own.tenant AND "
      "(rank_ms, ordinal) < (own.rank_ms, own.ordinal) LIMIT 1000) AS ahead) FROM jobs own WHERE job_id = ?");
  if (count.bind_text(job_id).step()) return count.integer(0);
  return count.status().ok() ? job_not_found(job_id) : count.status();
}

inline constexpr char kExpiredLeases[] =
    "SELECT job_id FROM jobs WHERE state = 2 AND lease_expires_ms <= ? ORDER BY lease_expires_ms LIMIT ?";
inline constexpr char kPassedDeadlines[] =
    "SELECT job_id FROM jobs WHERE state = 1 AND deadline_ms <= ? ORDER BY deadline_ms LIMIT ?";

inline constexpr char kEndedJobs[] =
    "SELECT job_id FROM jobs WHERE state > 2 AND end_ms <= ? ORDER BY end_ms LIMIT ?";

// The ids that one of the statements above finds.
template <class Database>
absl::StatusOr<std::vector<std::string>> overdue_jobs(Database& database, const char* sql, Time now,
                                                      int limit) {
  typename Database::Statement select(database, sql);
  select.bind(to_ms(now)).bind(limit);
  std::vector<std::string> found;
  while (select.step()) found.push_back(select.bytes(0));
  if (!select.status().ok()) return select.status();
  return found;
}

template <class Database>
absl::StatusOr<std::map<std::string, std::int64_t>> read_last_sequences(
    Database& database, const std::vector<std::string>& job_ids) {
  constexpr std::size_t kAtOnce = 500;  // parameters of one statement are bounded
  std::map<std::string, std::int64_t> last;
  for (std::size_t begin = 0; begin < job_ids.size(); begin += kAtOnce) {
    const std::size_t end = std::min(job_ids.size(), begin + kAtOnce);
    std::string sql = "SELECT job_id, last_sequence FROM jobs WHERE job_id IN (?";
    for (std::size_t i = begin + 1; i < end; ++i) sql += ", ?";
    typename Database::Statement select(database, sql + ")");
    for (std::size_t i = begin; i < end; ++i) select.bind_text(job_ids[i]);
    while (select.step()) last[select.bytes(0)] = select.integer(1);
    if (!select.status().ok()) return select.status();
  }
  return last;
}

// Writes a decision on the row, which is as it was before; after: the record as it shall be, and then is.
template <class Database>
absl::Status write_decision(Database& database, const JobRow& row, JobRecord& after,
                            std::vector<v1::JobEvent> events) {
  const std::string& checkpoint = row.record.job.checkpoint().sha256();
  if (!checkpoint.empty() && checkpoint != after.job.checkpoint().sha256()) {
    typename Database::Statement drop(database,
                                      "INSERT INTO dropped_checkpoints (tenant, sha256) VALUES (?, ?) "
                                      "ON CONFLICT (tenant, sha256) DO NOTHING");
    absl::Status status = drop.bind_text(row.record.job.tenant()).bind_text(checkpoint).run();
    if (!status.ok()) return status;
  }
  return write_change(database, row.ordinal, after, std::move(events));
}

struct Modified {
  JobRecord after;  // as it is now, changed or not
  bool changed = false;
  bool state_changed = false;
};

// The caller's decision on the job as it stands, locked where the store locks rows.
template <class Database>
absl::StatusOr<Modified> modify_job(Database& database, const std::string& job_id, const Decide& decide) {
  auto row = find_job(database, job_id, Database::kForUpdate);
  if (!row.ok()) return row.status();
  auto change = decide(row->record);
  if (!change.ok()) return change.status();
  Modified modified;
  modified.changed = change->has_value();
  if (!modified.changed) {
    modified.after = std::move(row->record);
    return modified;
  }
  modified.after = std::move((*change)->record);
  modified.state_changed = modified.after.job.state() != row->record.job.state();
  absl::Status status = write_decision(database, *row, modified.after, std::move((*change)->events));
  if (!status.ok()) return status;
  return modified;
}

// With its labels and events, when the caller permits it.
template <class Database>
absl::Status erase_job(Database& database, const std::string& job_id, const Permit& permit) {
  const auto row = find_job(database, job_id, Database::kForUpdate);
  if (!row.ok()) return row.status();
  if (absl::Status status = permit(row->record); !status.ok()) return status;
  typename Database::Statement erase(database, "DELETE FROM jobs WHERE ordinal = ?");
  return erase.bind(row->ordinal).run();
}

}  // namespace skinframe::server
