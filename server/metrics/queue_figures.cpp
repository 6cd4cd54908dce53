// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/queue_figures.h"

#include <algorithm>
#include <utility>

#include "proto/metrics/process_metrics.h"

namespace skinframe::server {

using metrics::add;
using metrics::family;
using prometheus::MetricFamily;
using prometheus::MetricType;

std::vector<TenantFigures> bounded(std::vector<TenantFigures> all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(), [](const TenantFigures& a, const TenantFigures& b) {
    return a.queued + a.running > b.queued + b.running;
  });
  if (all.size() <= most) return all;
  TenantFigures others{"(others)", 0, 0, {}};
  for (std::size_t i = most; i < all.size(); ++i) {
    others.queued += all[i].queued;
    others.running += all[i].running;
    if (!all[i].oldest_queued) continue;
    if (!others.oldest_queued || *all[i].oldest_queued < *others.oldest_queued)
      others.oldest_queued = all[i].oldest_queued;
  }
  all.resize(most);
  all.push_back(std::move(others));
  return all;
}

std::vector<MetricFamily> QueueFigures::Collect() const {
  MetricFamily up = family("skinframe_store_up", "1 when the store answered this scrape", MetricType::Gauge);
  MetricFamily queued = family("skinframe_jobs_queued", "Jobs that wait, by tenant", MetricType::Gauge);
  MetricFamily running =
      family("skinframe_jobs_running", "Jobs that a worker holds, by tenant", MetricType::Gauge);
  MetricFamily oldest =
      family("skinframe_oldest_queued_seconds",
             "Since the oldest job that waits was submitted, by tenant; 0: none waits", MetricType::Gauge);
  MetricFamily watchers = family("skinframe_watchers", "Watches of jobs at this server", MetricType::Gauge);
  MetricFamily waiting =
      family("skinframe_workers_waiting", "Workers that wait for a job at this server", MetricType::Gauge);
  MetricFamily expiries = family("skinframe_lease_expiries_total",
                                 "Leases that this server has ended unheard", MetricType::Counter);
  auto figures = store_.tenant_figures();
  add(up, figures.ok() ? 1 : 0);
  if (figures.ok()) {
    const Time now = clock_.now();
    for (const TenantFigures& of : bounded(*std::move(figures), kMostTenants)) {
      add(queued, static_cast<double>(of.queued), {{"tenant", of.tenant}});
      add(running, static_cast<double>(of.running), {{"tenant", of.tenant}});
      const auto age = of.oldest_queued ? now - *of.oldest_queued : Milliseconds(0);
      add(oldest, std::max(0.0, static_cast<double>(age.count()) / 1000.0), {{"tenant", of.tenant}});
    }
  }
  add(watchers, static_cast<double>(hub_.watchers()));
  add(waiting, static_cast<double>(desk_.waiting()));
  add(expiries, static_cast<double>(reaper_.expiries()));
  return {std::move(up),       std::move(queued),  std::move(running), std::move(oldest),
          std::move(watchers), std::move(waiting), std::move(expiries)};
}

}  // namespace skinframe::server
