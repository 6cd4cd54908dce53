// SPDX-License-Identifier: Apache-2.0
// A connection to PostgreSQL and its statements as values, in the form that job_rows.h asks for: libpqxx's
// exceptions become a status. Statements are written with ? and prepared once a connection. One session
// belongs to one thread at a time.
//
// UNAVAILABLE: the connection is lost or the server stops; broken() is true and the session of no further
// use. When that happens in COMMIT nobody knows whether the transaction was kept: all that is written through
// it may be asked for again (request ids, fencing tokens and completion digests see to that).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "absl/status/statusor.h"

namespace pqxx {
class result;
}

namespace skinframe::server {

class PostgresSession;

class PostgresStatement {
 public:
  PostgresStatement(PostgresSession& session, std::string_view sql);
  ~PostgresStatement();
  PostgresStatement(const PostgresStatement&) = delete;
  PostgresStatement& operator=(const PostgresStatement&) = delete;

  // Bind the next parameter. INVALID_ARGUMENT: a text with a zero byte, which PostgreSQL cannot hold.
  PostgresStatement& bind(std::int64_t value);
  PostgresStatement& bind_text(std::string_view value);
  PostgresStatement& bind_blob(std::string_view value);
  PostgresStatement& bind_null();

  bool step();         // executes at the first call; true: a row is there
  absl::Status run();  // steps to the end
  const absl::Status& status() const { return status_; }

  std::int64_t integer(int column) const;
  std::string bytes(int column) const;  // text or bytea
  bool is_null(int column) const;

 private:
  PostgresSession& session_;
  const std::string sql_;
  std::vector<std::optional<std::string>> parameters_;
  std::unique_ptr<pqxx::result> result_;
  int row_ = -1;
  absl::Status status_;
};

class PostgresSession {
 public:
  using Statement = PostgresStatement;
  static constexpr char kForUpdate[] = " FOR UPDATE";
  static constexpr char kSkipLocked[] = " FOR UPDATE SKIP LOCKED";
  // The number is this project's own; the lock goes with the transaction.
  static constexpr char kBeginMigration[] = "BEGIN; SELECT pg_advisory_xact_lock(736178667021)";

  // where: "postgresql://user:password@host/database?..." as libpq reads it. Commits of the session wait for
  // the disk whatever the server's default is, and no statement takes longer than 10 s. UNAVAILABLE,
  // INVALID_ARGUMENT (not to be parsed).
  static absl::StatusOr<std::unique_ptr<PostgresSession>> open(const std::string& where);
  ~PostgresSession();
  PostgresSession(const PostgresSession&) = delete;
  PostgresSession& operator=(const PostgresSession&) = delete;

  absl::Status execute(const std::string& sql);  // one or more statements without parameters or rows
  bool broken() const { return broken_; }

 private:
  friend class PostgresStatement;
  struct Connection;
  explicit PostgresSession(std::unique_ptr<Connection> connection);
  absl::Status failed(std::string_view doing);  // the exception under way, as a status

  std::unique_ptr<Connection> connection_;
  bool broken_ = false;
};

// The exception under way as a status: UNAVAILABLE for a lost connection, a deadlock or a time limit,
// RESOURCE_EXHAUSTED for a full disk, INTERNAL for the rest. lost: set where the connection is.
absl::Status postgres_status(std::string_view doing, bool& lost);

// `where` with limits for connecting and for a silent network, where it sets none itself.
std::string with_network_limits(const std::string& where);

}  // namespace skinframe::server
