// SPDX-License-Identifier: Apache-2.0
// The shape of a store as a numbered list of changes, each applied once and in its own transaction. Several
// servers may start on one store at the same time: whoever holds the store's lock migrates, the others find
// it done. See job_rows.h for Database; kBeginMigration begins a transaction that no other migration shares.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <span>
#include <string>

#include "absl/status/statusor.h"

namespace skinframe::server {

struct Migration {
  int version;       // 1, 2, 3 ...; a released step is never edited
  const char* name;  // for the log of applied steps
  const char* sql;
};

template <class Database>
absl::StatusOr<std::int64_t> schema_version(Database& database) {
  typename Database::Statement newest(database, "SELECT coalesce(max(version), 0) FROM schema_version");
  if (newest.step()) return newest.integer(0);
  return newest.status().ok() ? absl::InternalError("store: no schema version") : newest.status();
}

// One transaction: nothing when the version is there already.
template <class Database>
absl::Status apply_migration(Database& database, const Migration& step) {
  absl::Status status = database.execute(Database::kBeginMigration);
  if (!status.ok()) return status;
  const auto version = schema_version(database);
  status = version.status();
  if (status.ok() && *version < step.version) {
    status = database.execute(step.sql);
    if (status.ok()) {
      const auto now = std::chrono::system_clock::now().time_since_epoch();
      typename Database::Statement record(
          database, "INSERT INTO schema_version (version, name, applied_ms) VALUES (?, ?, ?)");
      status = record.bind(step.version)
                   .bind_text(step.name)
                   .bind(std::chrono::duration_cast<std::chrono::milliseconds>(now).count())
                   .run();
    }
  }
  if (status.ok()) status = database.execute("COMMIT");
  if (status.ok()) return status;
  database.execute("ROLLBACK").IgnoreError();  // the first error is the one to tell
  return absl::Status(status.code(), fmt::format("migration {} ({}): {}", step.version, step.name,
                                                 std::string(status.message())));
}

// Brings the store to the last of the steps. FAILED_PRECONDITION: it was made by a newer server.
template <class Database>
absl::Status migrate(Database& database, std::span<const Migration> steps) {
  absl::Status status = database.execute(Database::kBeginMigration);
  if (status.ok())
    status = database.execute(
        "CREATE TABLE IF NOT EXISTS schema_version "
        "(version INTEGER PRIMARY KEY, name TEXT NOT NULL, applied_ms BIGINT NOT NULL)");
  if (status.ok()) status = database.execute("COMMIT");
  if (!status.ok()) {
    database.execute("ROLLBACK").IgnoreError();  // the first error is the one to tell
    return status;
  }
  const auto version = schema_version(database);
  if (!version.ok()) return version.status();
  const std::int64_t known = steps.empty() ? 0 : steps.back().version;
  if (*version > known) {
    return absl::FailedPreconditionError(
        fmt::format("the store has schema version {}, this server knows up to {}: use the newer server",
                    *version, known));
  }
  for (const Migration& step : steps) {
    if (step.version <= *version) continue;
    if (status = apply_migration(database, step); !status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace skinframe::server
