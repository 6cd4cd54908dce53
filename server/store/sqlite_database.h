// SPDX-License-Identifier: Apache-2.0
// A connection to SQLite and its statements as values: closed when they go, errors as a status that names the
// statement. One connection belongs to one thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

struct sqlite3;
struct sqlite3_stmt;

namespace skinframe::server {

class SqliteDatabase;

// One use of a prepared statement; its bindings and its cursor go with it. Errors are kept until status() is
// asked: after the first one nothing further is done.
class SqliteStatement {
 public:
  SqliteStatement(SqliteDatabase& database, std::string_view sql);
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  // Bind the next parameter.
  SqliteStatement& bind(std::int64_t value);
  SqliteStatement& bind_text(std::string_view value);
  SqliteStatement& bind_blob(std::string_view value);
  SqliteStatement& bind_null();

  bool step();         // true: a row is there
  absl::Status run();  // steps to the end
  const absl::Status& status() const { return status_; }

  std::int64_t integer(int column) const;
  std::string bytes(int column) const;  // text or blob
  bool is_null(int column) const;

 private:
  void take(int code);

  SqliteDatabase& database_;
  sqlite3_stmt* statement_ = nullptr;
  int next_parameter_ = 1;
  absl::Status status_;
};

class SqliteDatabase {
 public:
  using Statement = SqliteStatement;
  // One connection writes, so that nothing needs to be locked row by row.
  static constexpr char kForUpdate[] = "";
  static constexpr char kSkipLocked[] = "";
  static constexpr char kBeginMigration[] = "BEGIN IMMEDIATE";

  enum class Mode { kReadWrite, kReadOnly };

  // Write-ahead log, synchronous=FULL: a commit that returned is on the disk.
  static absl::StatusOr<std::unique_ptr<SqliteDatabase>> open(const std::filesystem::path& file, Mode mode);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  absl::Status execute(const std::string& sql);  // one or more statements without parameters or rows

 private:
  friend class SqliteStatement;
  SqliteDatabase() = default;
  absl::Status error(int code, std::string_view what) const;

  sqlite3* handle_ = nullptr;
  std::unordered_map<std::string, sqlite3_stmt*> prepared_;  // by text
};

}  // namespace skinframe::server
