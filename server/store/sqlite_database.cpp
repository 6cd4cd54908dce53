// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite_database.h"

#include <fmt/format.h>
#include <sqlite3.h>

namespace skinframe::server {

SqliteStatement::SqliteStatement(SqliteDatabase& database, std::string_view sql) : database_(database) {
  auto [at, is_new] = database.prepared_.try_emplace(std::string(sql), nullptr);
  if (is_new) {
    const int code = sqlite3_prepare_v3(database.handle_, sql.data(), static_cast<int>(sql.size()),
                                        SQLITE_PREPARE_PERSISTENT, &at->second, nullptr);
    if (code != SQLITE_OK) {
      status_ = database.error(code, sql);
      database.prepared_.erase(at);
      return;
    }
  }
  statement_ = at->second;
}

SqliteStatement::~SqliteStatement() {
  if (statement_ == nullptr) return;
  sqlite3_reset(statement_);  // its code is that of the step before, which status() has
  sqlite3_clear_bindings(statement_);
}

void SqliteStatement::take(int code) {
  if (code != SQLITE_OK && status_.ok()) status_ = database_.error(code, sqlite3_sql(statement_));
}

SqliteStatement& SqliteStatement::bind(std::int64_t value) {
  if (status_.ok()) take(sqlite3_bind_int64(statement_, next_parameter_++, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind_text(std::string_view value) {
  if (status_.ok()) {
    take(sqlite3_bind_text64(statement_, next_parameter_++, value.data(), value.size(), SQLITE_TRANSIENT,
                             SQLITE_UTF8));
  }
  return *this;
}

SqliteStatement& SqliteStatement::bind_blob(std::string_view value) {
  if (status_.ok()) {
    // A null pointer would be bound as NULL, also for an empty blob.
    const char* bytes = value.empty() ? "" : value.data();
    take(sqlite3_bind_blob64(statement_, next_parameter_++, bytes, value.size(), SQLITE_TRANSIENT));
  }
  return *this;
}

SqliteStatement& SqliteStatement::bind_null() {
  if (status_.ok()) take(sqlite3_bind_null(statement_, next_parameter_++));
  return *this;
}

bool SqliteStatement::step() {
  if (!status_.ok()) return false;
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) take(code);
  return false;
}

absl::Status SqliteStatement::run() {
  while (step()) {
  }
  return status_;
}

std::int64_t SqliteStatement::integer(int column) const { return sqlite3_column_int64(statement_, column); }

std::string SqliteStatement::bytes(int column) const {
  const void* data = sqlite3_column_blob(statement_, column);
  if (data == nullptr) return {};
  return {static_cast<const char*>(data), static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

bool SqliteStatement::is_null(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

absl::StatusOr<std::unique_ptr<SqliteDatabase>> SqliteDatabase::open(const std::filesystem::path& file,
                                                                     Mode mode) {
  std::unique_ptr<SqliteDatabase> database(new SqliteDatabase);
  const int flags =
      (mode == Mode::kReadOnly ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) |
      SQLITE_OPEN_NOMUTEX;
  const int code = sqlite3_open_v2(file.c_str(), &database->handle_, flags, nullptr);
  if (code != SQLITE_OK) return database->error(code, "cannot open " + file.string());
  sqlite3_extended_result_codes(database->handle_, 1);
  std::string settings = "PRAGMA busy_timeout=5000; PRAGMA foreign_keys=ON;";
  if (mode == Mode::kReadWrite) settings += "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;";
  if (absl::Status status = database->execute(settings); !status.ok()) return status;
  return database;
}

SqliteDatabase::~SqliteDatabase() {
  for (const auto& [sql, statement] : prepared_) sqlite3_finalize(statement);
  sqlite3_close(handle_);
}

absl::Status SqliteDatabase::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  return code == SQLITE_OK ? absl::OkStatus() : error(code, sql);
}

absl::Status SqliteDatabase::error(int code, std::string_view what) const {
  const std::string message =
      fmt::format("store: {}: {}", handle_ != nullptr ? sqlite3_errmsg(handle_) : sqlite3_errstr(code), what);
  switch (code & 0xff) {
    case SQLITE_FULL:
      return absl::ResourceExhaustedError("no room on the server's disk (" + message + ")");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_IOERR:
      return absl::UnavailableError(message);
    default:
      return absl::InternalError(message);
  }
}

}  // namespace skinframe::server
