// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/queue/store_rates.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/fixture/example_job.h"

namespace skinframe::bench {
namespace {

using server::Change;
using server::JobRecord;
using SteadyClock = std::chrono::steady_clock;

constexpr std::int64_t kNoLimit = 10'000'000;
constexpr int kFillers = 64;

double seconds_since(SteadyClock::time_point begin) {
  return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

void check(const absl::Status& status) {
  if (!status.ok()) throw std::runtime_error(std::string(status.message()));
}

// Runs step(0 .. count - 1) on so many threads; how many a second. The first exception is passed on.
double rate_of(int count, int callers, const std::function<void(int)>& step) {
  std::atomic<int> next = 0;
  std::atomic<bool> failed = false;
  std::string why;
  std::vector<std::thread> threads;
  const auto begin = SteadyClock::now();
  for (int i = 0; i < callers; ++i) {
    threads.emplace_back([&] {
      try {
        for (int n = next++; n < count && !failed; n = next++) step(n);
      } catch (const std::exception& error) {
        if (!failed.exchange(true)) why = error.what();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  if (failed) throw std::runtime_error(why);
  return count / seconds_since(begin);
}

JobRecord lease(server::JobStore& store) {
  auto leased = store.lease_next(server::kNoon, [](const JobRecord& record, std::int64_t token) {
    return server::leased(record, token);
  });
  check(leased.status());
  if (!leased->has_value()) throw std::runtime_error("a lease found nothing though jobs are queued");
  return **std::move(leased);
}

}  // namespace

Rates measure_rates(server::JobStore& store, int jobs, int callers) {
  Rates rates;
  rates.enqueue = rate_of(jobs, callers, [&](int n) {
    check(store.create(server::example_job("job-" + std::to_string(n)), kNoLimit).status());
  });
  std::vector<std::int64_t> tokens(static_cast<std::size_t>(jobs));
  std::vector<std::string> ids(static_cast<std::size_t>(jobs));
  rates.lease = rate_of(jobs, callers, [&](int n) {
    const JobRecord job = lease(store);
    tokens[static_cast<std::size_t>(n)] = job.lease.fencing_token;
    ids[static_cast<std::size_t>(n)] = job.job.job_id();
  });
  rates.complete = rate_of(jobs, callers, [&](int n) {
    const auto at = static_cast<std::size_t>(n);
    const auto done = server::completion(ids[at], tokens[at], v1::JOB_STATE_SUCCEEDED);
    check(store
              .modify(ids[at],
                      [&](const JobRecord& record) {
                        return server::decide_complete(record, done, server::kNoon, {});
                      })
              .status());
  });
  return rates;
}

void fill(server::JobStore& store, int queued, int tenants) {
  rate_of(queued, kFillers, [&](int n) {
    Change job = server::example_job("job-" + std::to_string(n), n % 21 - 10);
    job.record.job.set_tenant("tenant-" + std::to_string(n % tenants));
    check(store.create(job, kNoLimit).status());
  });
}

std::vector<LeaseCost> measure_lease_costs(const std::vector<server::JobStore*>& stores, int leases) {
  std::vector<std::vector<double>> taken(stores.size()), duties(stores.size());
  for (int i = 0; i < leases; ++i) {
    for (std::size_t s = 0; s < stores.size(); ++s) {
      const auto begin = SteadyClock::now();
      const JobRecord job = lease(*stores[s]);
      taken[s].push_back(1e6 * seconds_since(begin));
      check(stores[s]
                ->modify(job.job.job_id(),
                         [&](const JobRecord& record) {
                           return server::decide_undelivered(record, job.lease.fencing_token, server::kNoon);
                         })
                .status());
      const auto look = SteadyClock::now();
      check(stores[s]->expired_leases(server::kNoon, 100).status());
      check(stores[s]->passed_deadlines(server::kNoon, 100).status());
      duties[s].push_back(1e6 * seconds_since(look));
    }
  }
  std::vector<LeaseCost> costs;
  for (std::size_t s = 0; s < stores.size(); ++s) {
    std::sort(taken[s].begin(), taken[s].end());
    std::sort(duties[s].begin(), duties[s].end());
    costs.push_back({taken[s][taken[s].size() / 2], taken[s][taken[s].size() * 95 / 100],
                     duties[s][duties[s].size() / 2]});
  }
  return costs;
}

}  // namespace skinframe::bench
