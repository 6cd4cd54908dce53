// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres_session.h"

#include <fmt/format.h>

#include <exception>
#include <pqxx/pqxx>

namespace skinframe::server {
namespace {

constexpr pqxx::oid kByteaOid = 17;

// No sorts where an index has the order: after a quiet day the planner's statistics know of no queued job,
// and it would sort the night's hundred thousand at each lease. No compiling of statements, which takes
// longer than any of ours runs and is started by the price that a forbidden sort is given.
constexpr char kSettings[] =
    "SET enable_sort = off; SET jit = off; SET synchronous_commit = on; SET statement_timeout = '10s'; "
    "SET lock_timeout = '5s'; SET idle_in_transaction_session_timeout = '30s'; "
    "SET client_min_messages = warning";

std::string hexadecimal(std::string_view bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "\\x";
  text.reserve(2 + 2 * bytes.size());
  for (const char c : bytes) {
    text += kDigits[static_cast<unsigned char>(c) >> 4];
    text += kDigits[static_cast<unsigned char>(c) & 15];
  }
  return text;
}

// "a = ? AND b = ?" as PostgreSQL writes it: "a = $1 AND b = $2". No literal of ours has a question mark.
std::string numbered(std::string_view sql) {
  std::string text;
  int next = 1;
  for (const char c : sql) {
    if (c == '?') {
      text += fmt::format("${}", next++);
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string with_network_limits(const std::string& where) {
  std::string limited = where;
  for (const char* limit : {"connect_timeout=5", "keepalives_idle=5", "keepalives_interval=2",
                            "keepalives_count=3", "tcp_user_timeout=10000"}) {
    const std::string name = std::string(limit).substr(0, std::string_view(limit).find('='));
    if (limited.find(name) != std::string::npos) continue;
    limited += limited.find('?') == std::string::npos ? '?' : '&';
    limited += limit;
  }
  return limited;
}

absl::Status postgres_status(std::string_view doing, bool& lost) {
  const auto told = [&](const std::exception& error) {
    std::string what = error.what();
    while (!what.empty() && what.back() == '\n') what.pop_back();
    return fmt::format("store: {}: {}", what, doing);
  };
  try {
    throw;
  } catch (const pqxx::broken_connection& error) {
    lost = true;
    return absl::UnavailableError(told(error));
  } catch (const pqxx::in_doubt_error& error) {
    lost = true;
    return absl::UnavailableError(told(error));
  } catch (const pqxx::disk_full& error) {
    return absl::ResourceExhaustedError("no room on the database's disk (" + told(error) + ")");
  } catch (const pqxx::out_of_memory& error) {
    return absl::UnavailableError(told(error));
  } catch (const pqxx::sql_error& error) {
    const std::string state = error.sqlstate();
    // 08 connection, 40 rollback, 53 resources, 55P03 lock, 57 the server's operator: the next try may do.
    const std::string family = state.substr(0, 2);
    if (family == "08" || family == "57") lost = true;
    if (state.empty()) lost = true;  // the answer never came
    const bool passing = lost || family == "40" || family == "53" || state == "55P03" || state == "57014";
    return passing ? absl::UnavailableError(told(error)) : absl::InternalError(told(error));
  } catch (const std::exception& error) {
    return absl::InternalError(told(error));
  }
}

struct PostgresSession::Connection {
  explicit Connection(const std::string& where) : link(where) {}
  pqxx::connection link;
  std::unique_ptr<pqxx::nontransaction> use;              // BEGIN and COMMIT are statements of ours
  std::unordered_map<std::string, std::string> prepared;  // by text
};

PostgresSession::PostgresSession(std::unique_ptr<Connection> connection)
    : connection_(std::move(connection)) {}

PostgresSession::~PostgresSession() = default;

absl::StatusOr<std::unique_ptr<PostgresSession>> PostgresSession::open(const std::string& where) {
  bool lost = false;
  try {
    auto connection = std::make_unique<Connection>(with_network_limits(where));
    connection->use = std::make_unique<pqxx::nontransaction>(connection->link);
    connection->use->exec(kSettings);
    return std::unique_ptr<PostgresSession>(new PostgresSession(std::move(connection)));
  } catch (...) {
    return postgres_status("connecting", lost);
  }
}

absl::Status PostgresSession::failed(std::string_view doing) {
  absl::Status status = postgres_status(doing, broken_);
  if (!connection_->link.is_open()) broken_ = true;
  return status;
}

absl::Status PostgresSession::execute(const std::string& sql) {
  try {
    connection_->use->exec(sql);
    return absl::OkStatus();
  } catch (...) {
    return failed(sql);
  }
}

PostgresStatement::PostgresStatement(PostgresSession& session, std::string_view sql)
    : session_(session), sql_(sql) {}

PostgresStatement::~PostgresStatement() = default;

PostgresStatement& PostgresStatement::bind(std::int64_t value) {
  parameters_.emplace_back(fmt::to_string(value));
  return *this;
}

PostgresStatement& PostgresStatement::bind_text(std::string_view value) {
  if (value.find('\0') != std::string_view::npos && status_.ok())
    status_ = absl::InvalidArgumentError("a text with a zero byte cannot be stored");
  parameters_.emplace_back(std::string(value));
  return *this;
}

PostgresStatement& PostgresStatement::bind_blob(std::string_view value) {
  parameters_.emplace_back(hexadecimal(value));
  return *this;
}

PostgresStatement& PostgresStatement::bind_null() {
  parameters_.emplace_back();
  return *this;
}

bool PostgresStatement::step() {
  if (!status_.ok()) return false;
  if (result_ == nullptr) {
    try {
      auto& connection = *session_.connection_;
      auto [at, is_new] = connection.prepared.try_emplace(sql_);
      if (is_new) {
        at->second = fmt::format("statement_{}", connection.prepared.size());
        connection.link.prepare(at->second, numbered(sql_));
      }
      result_ = std::make_unique<pqxx::result>(
          connection.use->exec_prepared(at->second, pqxx::prepare::make_dynamic_params(parameters_)));
    } catch (...) {
      status_ = session_.failed(sql_);
      return false;
    }
  }
  return ++row_ < static_cast<int>(result_->size());
}

absl::Status PostgresStatement::run() {
  while (step()) {
  }
  return status_;
}

std::int64_t PostgresStatement::integer(int column) const {
  return is_null(column) ? 0 : (*result_)[row_][column].as<std::int64_t>();
}

std::string PostgresStatement::bytes(int column) const {
  const pqxx::field field = (*result_)[row_][column];
  if (field.is_null()) return {};
  if (field.type() == kByteaOid) return pqxx::binarystring(field).str();
  return {field.c_str(), field.size()};
}

bool PostgresStatement::is_null(int column) const { return (*result_)[row_][column].is_null(); }

}  // namespace skinframe::server
