// SPDX-License-Identifier: Apache-2.0
// The store that several servers share: PostgreSQL 13 or newer. A job's row is locked while a decision is
// taken on it; a lease skips the rows that others hold. Changes of state, and they alone, are told to the
// other servers by NOTIFY, after the commit (postgres_herald.h).
//
// The queue's limit is looked at when a job is made, without a lock: as many jobs as are made in the same
// instant may exceed it.
#pragma once

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/store/job_store.h"

namespace skinframe::server {

struct PostgresOptions {
  std::string where;       // postgresql://..., as libpq reads it
  int most_sessions = 16;  // of one server; 1 .. 1000, beside the one that listens
};

// Connects and migrates. listener may be null; else it outlives the store, and hears of this server's commits
// on the committing thread and of the others' on a thread of the store's own.
absl::StatusOr<std::unique_ptr<JobStore>> open_postgres_store(const PostgresOptions& options,
                                                              CommitListener* listener);

}  // namespace skinframe::server
