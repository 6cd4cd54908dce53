// SPDX-License-Identifier: Apache-2.0
// The shape of the SQLite store, as a numbered list of steps. A step that has been released is never edited:
// what changes later is a further step.
#pragma once

#include <span>

#include "absl/status/status.h"
#include "server/store/sqlite_database.h"

namespace skinframe::server {

struct Migration {
  int version;       // 1, 2, 3 ...
  const char* name;  // for the log of applied steps
  const char* sql;
};

std::span<const Migration> sqlite_migrations();

// Brings the database to the newest version, each step in a transaction of its own. FAILED_PRECONDITION: it
// was written by a newer server.
absl::Status migrate(SqliteDatabase& database, std::span<const Migration> steps);

}  // namespace skinframe::server
