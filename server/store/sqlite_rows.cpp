// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite_rows.h"

#include <fmt/format.h>

#include "skinframe/v1/worker.pb.h"

namespace skinframe::server {
namespace {

std::int64_t to_ms(Time time) { return time.time_since_epoch().count(); }
Time from_ms(std::int64_t ms) { return Time(Milliseconds(ms)); }

std::string profiles_blob(const JobRecord& record) {
  v1::Assignment profiles;
  for (const auto& printer : record.printers) *profiles.add_printers() = printer;
  for (const auto& material : record.materials) *profiles.add_materials() = material;
  for (const auto& file : record.warm_start_files) *profiles.add_warm_start_files() = file;
  return profiles.SerializeAsString();
}

std::string results_blob(const JobRecord& record) {
  v1::Job results;
  *results.mutable_printers() = record.job.printers();
  *results.mutable_files() = record.job.files();
  if (record.job.has_frame()) *results.mutable_frame() = record.job.frame();
  return results.SerializeAsString();
}

// The columns that change after submission, in the order in which both INSERT and UPDATE name them.
constexpr char kMutableInsert[] =
    "state, reason, detail, results, start_ms, end_ms, attempt, lost_attempts, not_before_ms, "
    "cancel_requested, "
    "last_sequence, fencing_token, worker_id, instance_id, lease_expires_ms, completion_digest";
constexpr char kMutableUpdate[] =
    "state = ?, reason = ?, detail = ?, results = ?, start_ms = ?, end_ms = ?, attempt = ?, lost_attempts = "
    "?, "
    "not_before_ms = ?, cancel_requested = ?, last_sequence = ?, fencing_token = ?, worker_id = ?, "
    "instance_id = ?, lease_expires_ms = ?, completion_digest = ?";

void bind_time(SqliteStatement& statement, bool present, const google::protobuf::Timestamp& time) {
  if (present) {
    statement.bind(to_ms(from_timestamp(time)));
  } else {
    statement.bind_null();
  }
}

void bind_mutable(SqliteStatement& statement, const JobRecord& record) {
  const v1::Job& job = record.job;
  statement.bind(job.state()).bind(job.reason()).bind_text(job.detail()).bind_blob(results_blob(record));
  bind_time(statement, job.has_start_time(), job.start_time());
  bind_time(statement, job.has_end_time(), job.end_time());
  statement.bind(job.attempt()).bind(record.lost_attempts).bind(to_ms(record.not_before));
  statement.bind(job.cancel_requested() ? 1 : 0).bind(job.last_sequence()).bind(record.lease.fencing_token);
  statement.bind_text(record.lease.worker_id).bind_text(record.lease.instance_id);
  statement.bind(to_ms(record.lease.expires)).bind_text(record.completion_digest);
}

absl::Status insert_labels(SqliteDatabase& database, std::int64_t ordinal, const v1::JobSpec& spec) {
  for (const auto& [key, value] : spec.labels()) {
    SqliteStatement insert(database, "INSERT INTO labels (ordinal, key, value) VALUES (?, ?, ?)");
    if (absl::Status status = insert.bind(ordinal).bind_text(key).bind_text(value).run(); !status.ok())
      return status;
  }
  return absl::OkStatus();
}

}  // namespace

const char* const kJobColumns =
    "ordinal, job_id, request_id, spec_digest, spec, profiles, create_ms, deadline_ms, state, reason, "
    "detail, "
    "results, start_ms, end_ms, attempt, lost_attempts, not_before_ms, cancel_requested, last_sequence, "
    "fencing_token, worker_id, instance_id, lease_expires_ms, completion_digest";

absl::StatusOr<JobRow> read_row(const SqliteStatement& row) {
  JobRow result;
  JobRecord& record = result.record;
  v1::Job& job = record.job;
  v1::Assignment profiles;
  int column = 0;
  result.ordinal = row.integer(column++);
  const std::string job_id = row.bytes(column++);
  record.request_id = row.bytes(column++);
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
    return absl::InternalError(fmt::format("store: job {} does not parse: the file is damaged", job_id));
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
  return result;
}

absl::StatusOr<JobRow> find_job(SqliteDatabase& database, const std::string& job_id) {
  static const std::string kSql = fmt::format("SELECT {} FROM jobs WHERE job_id = ?", kJobColumns);
  SqliteStatement select(database, kSql);
  if (select.bind_text(job_id).step()) return read_row(select);
  return select.status().ok() ? job_not_found(job_id) : select.status();
}

absl::StatusOr<std::int64_t> insert_job(SqliteDatabase& database, const JobRecord& record) {
  static const std::string kSql = fmt::format(
      "INSERT INTO jobs (job_id, request_id, spec_digest, spec, profiles, priority, create_ms, deadline_ms, "
      "{}) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      kMutableInsert);
  const v1::Job& job = record.job;
  SqliteStatement insert(database, kSql);
  insert.bind_text(job.job_id());
  if (record.request_id.empty()) {
    insert.bind_null();
  } else {
    insert.bind_text(record.request_id);
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
  bind_mutable(insert, record);
  if (absl::Status status = insert.run(); !status.ok()) return status;
  const std::int64_t ordinal = database.last_row_id();
  if (absl::Status status = insert_labels(database, ordinal, job.spec()); !status.ok()) return status;
  return ordinal;
}

absl::Status update_job(SqliteDatabase& database, std::int64_t ordinal, const JobRecord& record) {
  static const std::string kSql = fmt::format("UPDATE jobs SET {} WHERE ordinal = ?", kMutableUpdate);
  SqliteStatement update(database, kSql);
  bind_mutable(update, record);
  return update.bind(ordinal).run();
}

absl::Status append_events(SqliteDatabase& database, std::int64_t ordinal, JobRecord& record,
                           std::vector<v1::JobEvent> events) {
  for (v1::JobEvent& event : events) {
    const std::int64_t sequence = record.job.last_sequence() + 1;
    event.set_job_id(record.job.job_id());
    event.set_sequence(sequence);
    SqliteStatement insert(database, "INSERT INTO events (ordinal, sequence, body) VALUES (?, ?, ?)");
    absl::Status status = insert.bind(ordinal).bind(sequence).bind_blob(event.SerializeAsString()).run();
    if (!status.ok()) return status;
    record.job.set_last_sequence(sequence);
  }
  return absl::OkStatus();
}

absl::Status job_not_found(const std::string& job_id) {
  return absl::NotFoundError(fmt::format("no job \"{}\"", job_id));
}

}  // namespace skinframe::server
