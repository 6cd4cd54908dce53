// SPDX-License-Identifier: Apache-2.0
// Statements for whoever operates the store: what it holds, and what is to be cleared away. The same for
// every SQL store; see job_rows.h for Database.
#pragma once

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/store/job_rows.h"
#include "server/store/job_store.h"

namespace skinframe::server {

// By the index of states alone, but for the oldest of each: jobs are numbered as they are submitted.
inline constexpr char kTenantFigures[] =
    "SELECT sums.tenant, sums.state, sums.jobs, (SELECT create_ms FROM jobs WHERE ordinal = sums.oldest) "
    "FROM "
    "(SELECT tenant, state, count(*) AS jobs, min(ordinal) AS oldest FROM jobs WHERE state IN (1, 2) "
    "GROUP BY tenant, state) AS sums ORDER BY sums.tenant, sums.state";

template <class Database>
absl::StatusOr<std::vector<TenantFigures>> read_tenant_figures(Database& database) {
  typename Database::Statement select(database, kTenantFigures);
  std::vector<TenantFigures> all;
  while (select.step()) {
    if (all.empty() || all.back().tenant != select.bytes(0)) all.push_back({select.bytes(0), 0, 0, {}});
    const bool queued = select.integer(1) == v1::JOB_STATE_QUEUED;
    (queued ? all.back().queued : all.back().running) = select.integer(2);
    if (queued) all.back().oldest_queued = from_ms(select.integer(3));
  }
  if (!select.status().ok()) return select.status();
  return all;
}

template <class Database>
absl::StatusOr<std::vector<DroppedCheckpoint>> read_dropped(Database& database, int limit) {
  typename Database::Statement select(
      database, "SELECT tenant, sha256 FROM dropped_checkpoints ORDER BY tenant, sha256 LIMIT ?");
  std::vector<DroppedCheckpoint> dropped;
  select.bind(limit);
  while (select.step()) dropped.push_back({select.bytes(0), select.bytes(1)});
  if (!select.status().ok()) return select.status();
  return dropped;
}

template <class Database>
absl::Status forget_dropped_rows(Database& database, const std::vector<DroppedCheckpoint>& seen_to) {
  for (const DroppedCheckpoint& row : seen_to) {
    typename Database::Statement erase(database,
                                       "DELETE FROM dropped_checkpoints WHERE tenant = ? AND sha256 = ?");
    absl::Status status = erase.bind_text(row.tenant).bind_text(row.sha256).run();
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace skinframe::server
