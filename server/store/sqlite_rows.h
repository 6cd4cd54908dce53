// SPDX-License-Identifier: Apache-2.0
// Job records and events as rows. Each function is one or two statements within the caller's transaction.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/jobs/job_record.h"
#include "server/store/sqlite_database.h"

namespace skinframe::server {

struct JobRow {
  std::int64_t ordinal = 0;
  JobRecord record;
};

// The columns that read_row() expects, in its order.
extern const char* const kJobColumns;

// The row under the statement's cursor. INTERNAL: a blob that does not parse.
absl::StatusOr<JobRow> read_row(const SqliteStatement& statement);

// NOT_FOUND.
absl::StatusOr<JobRow> find_job(SqliteDatabase& database, const std::string& job_id);

// Inserts the record with its labels; returns its ordinal.
absl::StatusOr<std::int64_t> insert_job(SqliteDatabase& database, const JobRecord& record);

// Writes what may change after submission.
absl::Status update_job(SqliteDatabase& database, std::int64_t ordinal, const JobRecord& record);

// Numbers the events after record.job.last_sequence, appends them, and raises last_sequence.
absl::Status append_events(SqliteDatabase& database, std::int64_t ordinal, JobRecord& record,
                           std::vector<v1::JobEvent> events);

absl::Status job_not_found(const std::string& job_id);

}  // namespace skinframe::server
