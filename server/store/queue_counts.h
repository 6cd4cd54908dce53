// SPDX-License-Identifier: Apache-2.0
// How many jobs are queued, in all and of each tenant, without counting them at each submission: what was
// counted last, and one more for each job made since. Jobs that left the queue since are not taken off, so
// the number is never too small where this server alone writes, and before a job is refused it is counted
// afresh. Where several servers share the store, what the others made is seen within kGoodFor.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class QueueCounts {
 public:
  static constexpr std::chrono::seconds kGoodFor{1};

  explicit QueueCounts(bool others_write) : others_write_(others_write) {}

  // From any thread, within the transaction that makes the job.
  template <class Database>
  absl::Status permit_one_more(Database& database, const std::string& tenant, const QueueLimits& limits) {
    const auto all = below(database, nullptr, limits.all);
    if (!all.ok()) return all.status();
    if (*all >= limits.all)
      return absl::ResourceExhaustedError(
          fmt::format("the queue is full: {} jobs wait; try again when some of them have started", *all));
    if (limits.of_tenant == std::numeric_limits<std::int64_t>::max()) return absl::OkStatus();
    const auto own = below(database, &tenant, limits.of_tenant);
    if (!own.ok()) return own.status();
    if (*own < limits.of_tenant) return absl::OkStatus();
    return absl::ResourceExhaustedError(
        fmt::format("tenant \"{}\" has {} queued jobs, which is its quota of queued jobs; wait until some "
                    "have started, or cancel some",
                    tenant, *own));
  }

  void add_one(const std::string& tenant) {
    const std::lock_guard lock(mutex_);
    ++all_.jobs;
    ++of_[tenant].jobs;
  }

 private:
  using SteadyClock = std::chrono::steady_clock;
  struct Count {
    std::int64_t jobs = 0;
    SteadyClock::time_point counted{};  // never yet
  };

  // The number of queued jobs when it is below the limit; else the limit. tenant null: of all.
  template <class Database>
  absl::StatusOr<std::int64_t> below(Database& database, const std::string* tenant, std::int64_t limit) {
    {
      const std::lock_guard lock(mutex_);
      const Count& count = tenant == nullptr ? all_ : of_[*tenant];
      const bool known = count.counted != SteadyClock::time_point{};
      const bool good = known && (!others_write_ || SteadyClock::now() - count.counted < kGoodFor);
      if (good && count.jobs < limit) return count.jobs;
    }
    // Counts no further than the limit.
    typename Database::Statement queued(
        database, fmt::format("SELECT count(*) FROM (SELECT 1 FROM jobs WHERE state = 1{} LIMIT ?) AS queued",
                              tenant == nullptr ? "" : " AND tenant = ?"));
    if (tenant != nullptr) queued.bind_text(*tenant);
    if (!queued.bind(limit).step()) return queued.status();
    const std::lock_guard lock(mutex_);
    Count& count = tenant == nullptr ? all_ : of_[*tenant];
    count = {queued.integer(0), SteadyClock::now()};
    return count.jobs;
  }

  const bool others_write_;
  std::mutex mutex_;  // guards what follows
  Count all_;
  std::map<std::string, Count> of_;
};

}  // namespace skinframe::server
