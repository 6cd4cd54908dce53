// SPDX-License-Identifier: Apache-2.0
// The calls of JobStore that only read, the same for every SQL store. Source lends a Database for one call:
// with([](Database&) { ... }), and each statement sees what was committed before it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/store/job_queries.h"
#include "server/store/job_store.h"
#include "server/store/operating_queries.h"

namespace skinframe::server {

template <class Database, class Source>
class SqlReads : public JobStore {
 public:
  absl::StatusOr<JobRecord> get(const std::string& job_id) final {
    return source().with([&](Database& database) -> absl::StatusOr<JobRecord> {
      auto row = find_job(database, job_id);
      if (!row.ok()) return row.status();
      return std::move(row->record);
    });
  }

  absl::StatusOr<ListPage> list(const ListQuery& query) final {
    return source().with([&](Database& database) { return list_jobs(database, query); });
  }

  absl::StatusOr<std::vector<v1::JobEvent>> events(const std::string& job_id, std::int64_t after_sequence,
                                                   int limit) final {
    return source().with(
        [&](Database& database) { return read_events(database, job_id, after_sequence, limit); });
  }

  absl::StatusOr<std::optional<JobRecord>> find_reusable(const std::string& tenant,
                                                         const std::string& reuse_key) final {
    return source().with([&](Database& database) { return newest_reusable(database, tenant, reuse_key); });
  }

  absl::StatusOr<std::int64_t> queued_before(const std::string& job_id) final {
    return source().with([&](Database& database) { return count_queued_before(database, job_id); });
  }

  absl::StatusOr<std::vector<std::string>> expired_leases(Time now, int limit) final {
    return overdue(kExpiredLeases, now, limit);
  }
  absl::StatusOr<std::vector<std::string>> passed_deadlines(Time now, int limit) final {
    return overdue(kPassedDeadlines, now, limit);
  }
  absl::StatusOr<std::vector<std::string>> ended_jobs(Time until, int limit) final {
    return overdue(kEndedJobs, until, limit);
  }

  absl::StatusOr<std::vector<TenantFigures>> tenant_figures() final {
    return source().with([](Database& database) { return read_tenant_figures(database); });
  }

  absl::StatusOr<std::vector<DroppedCheckpoint>> dropped_checkpoints(int limit) final {
    return source().with([&](Database& database) { return read_dropped(database, limit); });
  }

  absl::StatusOr<std::map<std::string, std::int64_t>> last_sequences(
      const std::vector<std::string>& job_ids) final {
    return source().with([&](Database& database) { return read_last_sequences(database, job_ids); });
  }

 protected:
  virtual Source& source() = 0;

 private:
  absl::StatusOr<std::vector<std::string>> overdue(const char* sql, Time now, int limit) {
    return source().with([&](Database& database) { return overdue_jobs(database, sql, now, limit); });
  }
};

}  // namespace skinframe::server
