// SPDX-License-Identifier: Apache-2.0
// Job records and events as rows, the same for every SQL store. Each function is one or two statements within
// the caller's transaction.
//
// Database is SqliteDatabase or PostgresSession. Either has
//   Statement                 bind(), bind_text(), bind_blob(), bind_null() in the order of the ?;
//                             step(), run(), status(); integer(), bytes(), is_null() of a column
//   kForUpdate, kSkipLocked   what a SELECT ends with to lock its rows, where the store locks rows
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "server/jobs/job_record.h"
#include "skinframe/v1/worker.pb.h"

namespace skinframe::server {

struct JobRow {
  std::int64_t ordinal = 0;
  JobRecord record;
};

// The columns that read_row() expects, in its order.
inline constexpr char kJobColumns[] =
    "ordinal, job_id, request_id, spec_digest, spec, profiles, create_ms, deadline_ms, state, reason, "
    "detail, results, start_ms, end_ms, attempt, lost_attempts, not_before_ms, cancel_requested, "
    "last_sequence, fencing_token, worker_id, instance_id, lease_expires_ms, completion_digest, tenant, "
    "reuse_key, rank_ms";

inline absl::Status job_not_found(const std::string& job_id) {
  return absl::NotFoundError(fmt::format("no job \"{}\"", job_id));
}

inline std::int64_t to_ms(Time time) { return time.time_since_epoch().count(); }
inline Time from_ms(std::int64_t ms) { return Time(Milliseconds(ms)); }

// A request id is its tenant's own. Neither has a slash.
inline std::string request_key(const std::string& tenant, const std::string& request_id) {
  return tenant == kDefaultTenant ? request_id : tenant + "/" + request_id;
}
inline std::string request_id_of(const std::string& key) {
  const std::size_t slash = key.find('/');
  return slash == std::string::npos ? key : key.substr(slash + 1);
}

inline std::string profiles_blob(const JobRecord& record) {
  v1::Assignment profiles;
  for (const auto& printer : record.printers) *profiles.add_printers() = printer;
  for (const auto& material : record.materials) *profiles.add_materials() = material;
  for (const auto& file : record.warm_start_files) *profiles.add_warm_start_files() = file;
  return profiles.SerializeAsString();
}

inline std::string results_blob(const JobRecord& record) {
  v1::Job results;
  *results.mutable_printers() = record.job.printers();
  *results.mutable_files() = record.job.files();
  if (record.job.has_frame()) *results.mutable_frame() = record.job.frame();
  results.set_reused_job_id(record.job.reused_job_id());
  if (record.job.has_checkpoint()) *results.mutable_checkpoint() = record.job.checkpoint();
  return results.SerializeAsString();
}

// The columns that change after submission, in the order in which both INSERT and UPDATE name them.
inline constexpr char kMutableInsert[] =
    "state, reason, detail, results, start_ms, end_ms, attempt, lost_attempts, not_before_ms, "
    "cancel_requested, last_sequence, fencing_token, worker_id, instance_id, lease_expires_ms, "
    "completion_digest";
inline constexpr char kMutableUpdate[] =
    "state = ?, reason = ?, detail = ?, results = ?, start_ms = ?, end_ms = ?, attempt = ?, "
    "lost_attempts = ?, not_before_ms = ?, cancel_requested = ?, last_sequence = ?, fencing_token = ?, "
    "worker_id = ?, instance_id = ?, lease_expires_ms = ?, completion_digest = ?";

template <class Statement>
void bind_time(Statement& statement, bool present, const google::protobuf::Timestamp& time) {
  if (present) {
    statement.bind(to_ms(from_timestamp(time)));
  } else {
    statement.bind_null();
  }
}

template <class Statement>
void bind_mutable(Statement& statement, const JobRecord& record) {
  const v1::Job& job = record.job;
  statement.bind(job.state()).bind(job.reason()).bind_text(job.detail()).bind_blob(results_blob(record));
  bind_time(statement, job.has_start_time(), job.start_time());
  bind_time(statement, job.has_end_time(), job.end_time());
  statement.bind(job.attempt()).bind(record.lost_attempts).bind(to_ms(record.not_before));
  statement.bind(job.cancel_requested() ? 1 : 0).bind(job.last_sequence()).bind(record.lease.fencing_token);
  statement.bind_text(record.lease.worker_id).bind_text(record.lease.instance_id);
  statement.bind(to_ms(record.lease.expires)).bind_text(record.completion_digest);
}

template <class Database>
absl::Status insert_labels(Database& database, std::int64_t ordinal, const v1::JobSpec& spec) {
  for (const auto& [key, value] : spec.labels()) {
    typename Database::Statement insert(database,
                                        "INSERT INTO labels (ordinal, key, value) VALUES (?, ?, ?)");
    if (absl::Status status = insert.bind(ordinal).bind_text(key).bind_text(value).run(); !status.ok())
      return status;
  }
  return absl::OkStatus();
}

// The row under the statement's cursor. INTERNAL: a blob that does not parse.
template <class Statement>
absl::StatusOr<JobRow> read_row(const Statement& row) {
  JobRow result;
  JobRecord& record = result.record;
  v1::Job& job = record.job;
  v1::Assignment profiles;
  int column = 0;
  result.ordinal = row.integer(column++);
  const std::string job_id = row.bytes(column++);
  record.request_id = request_id_of(row.bytes(column++));
  record.spec_digest = row.bytes(column++);
  const std::string spec = row.bytes(column++);
  const std::string profile_bytes = row.bytes(column++);
  *job.mutable_create_time() = to_timestamp(from_ms(row.integer(column++)));
  if (!row.is_null(column)) record.deadline = from_ms(row.integer(column));
  ++column;
  job.set_state(static_cast<v1::JobState>(row.integer(column++)));
  job.set_reason(static_cast<v1::Reason>(row.integer(column++)));
  job.set_detail(row.bytes(column++));
  if (!job.MergeFromString(row.bytes(column++)) || !job.mutable_spec()->ParseFromString(spec) ||
      !profiles.ParseFromString(profile_bytes)) {
    return absl::InternalError(fmt::format("store: job {} does not parse: the store is damaged", job_id));
  }
  job.set_job_id(job_id);
  record.printers.assign(profiles.printers().begin(), profiles.printers().end());
  record.materials.assign(profiles.materials().begin(), profiles.materials().end());
  record.warm_start_files.assign(profiles.warm_start_files().begin(), profiles.warm_start_files().end());
  if (!row.is_null(column)) *job.mutable_start_time() = to_timestamp(from_ms(row.integer(column)));
  ++column;
  if (!row.is_null(column)) *job.mutable_end_time() = to_timestamp(from_ms(row.integer(column)));
  ++column;
  job.set_attempt(static_cast<int>(row.integer(column++)));
  record.lost_attempts = static_cast<int>(row.integer(column++));
  record.not_before = from_ms(row.integer(column++));
  job.set_cancel_requested(row.integer(column++) != 0);
  job.set_last_sequence(row.integer(column++));
  record.lease.fencing_token = row.integer(column++);
  record.lease.worker_id = row.bytes(column++);
  record.lease.instance_id = row.bytes(column++);
  record.lease.expires = from_ms(row.integer(column++));
  record.completion_digest = row.bytes(column++);
  job.set_tenant(row.bytes(column++));
  record.reuse_key = row.bytes(column++);
  record.rank_ms = row.integer(column++);
  return result;
}

// NOT_FOUND. locking: "" or Database::kForUpdate.
template <class Database>
absl::StatusOr<JobRow> find_job(Database& database, const std::string& job_id, const char* locking = "") {
  typename Database::Statement select(
      database, fmt::format("SELECT {} FROM jobs WHERE job_id = ?{}", kJobColumns, locking));
  if (select.bind_text(job_id).step()) return read_row(select);
  return select.status().ok() ? job_not_found(job_id) : select.status();
}

// Inserts the record with its labels. Its ordinal; nothing when a job with its request id is there already.
template <class Database>
absl::StatusOr<std::optional<std::int64_t>> insert_job(Database& database, const JobRecord& record) {
  static const std::string kSql = fmt::format(
      "INSERT INTO jobs (job_id, request_id, spec_digest, spec, profiles, priority, create_ms, "
      "deadline_ms, tenant, reuse_key, rank_ms, {}) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) "
      "ON CONFLICT (request_id) DO NOTHING RETURNING ordinal",
      kMutableInsert);
  const v1::Job& job = record.job;
  typename Database::Statement insert(database, kSql);
  insert.bind_text(job.job_id());
  if (record.request_id.empty()) {
    insert.bind_null();
  } else {
    insert.bind_text(request_key(job.tenant(), record.request_id));
  }
  insert.bind_text(record.spec_digest)
      .bind_blob(job.spec().SerializeAsString())
      .bind_blob(profiles_blob(record));
  insert.bind(job.spec().priority());
  bind_time(insert, true, job.create_time());
  if (record.deadline) {
    insert.bind(to_ms(*record.deadline));
  } else {
    insert.bind_null();
  }
  insert.bind_text(job.tenant());
  if (record.reuse_key.empty()) {
    insert.bind_null();
  } else {
    insert.bind_text(record.reuse_key);
  }
  insert.bind(record.rank_ms);
  bind_mutable(insert, record);
  if (!insert.step()) {
    if (!insert.status().ok()) return insert.status();
    return std::optional<std::int64_t>();
  }
  const std::int64_t ordinal = insert.integer(0);
  if (absl::Status status = insert.run(); !status.ok()) return status;
  if (absl::Status status = insert_labels(database, ordinal, job.spec()); !status.ok()) return status;
  return std::optional(ordinal);
}

// Writes what may change after submission.
template <class Database>
absl::Status update_job(Database& database, std::int64_t ordinal, const JobRecord& record) {
  static const std::string kSql = fmt::format("UPDATE jobs SET {} WHERE ordinal = ?", kMutableUpdate);
  typename Database::Statement update(database, kSql);
  bind_mutable(update, record);
  return update.bind(ordinal).run();
}

// Numbers the events after record.job.last_sequence, appends them, and raises last_sequence.
template <class Database>
absl::Status append_events(Database& database, std::int64_t ordinal, JobRecord& record,
                           std::vector<v1::JobEvent> events) {
  for (v1::JobEvent& event : events) {
    const std::int64_t sequence = record.job.last_sequence() + 1;
    event.set_job_id(record.job.job_id());
    event.set_sequence(sequence);
    typename Database::Statement insert(
        database, "INSERT INTO events (ordinal, sequence, progress, body) VALUES (?, ?, ?, ?)");
    absl::Status status = insert.bind(ordinal)
                              .bind(sequence)
                              .bind(event.has_progress() ? 1 : 0)
                              .bind_blob(event.SerializeAsString())
                              .run();
    if (!status.ok()) return status;
    record.job.set_last_sequence(sequence);
  }
  return absl::OkStatus();
}

// Events first: they raise last_sequence, which the row then holds.
template <class Database>
absl::Status write_change(Database& database, std::int64_t ordinal, JobRecord& record,
                          std::vector<v1::JobEvent> events) {
  absl::Status status = append_events(database, ordinal, record, std::move(events));
  return status.ok() ? update_job(database, ordinal, record) : status;
}

}  // namespace skinframe::server
