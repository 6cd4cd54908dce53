// SPDX-License-Identifier: Apache-2.0
// How the queue stands, asked of the store at a scrape: of the store as a whole, so that several servers on
// one database show the same; and who waits at this server. At most kMostTenants tenants have rows of their
// own, those with the most jobs; the rest share one, named "(others)", which is no tenant's name.
#pragma once

#include <prometheus/collectable.h>

#include "server/events/watch_hub.h"
#include "server/jobs/clock.h"
#include "server/leases/lease_desk.h"
#include "server/leases/lease_reaper.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class QueueFigures final : public prometheus::Collectable {
 public:
  static constexpr std::size_t kMostTenants = 20;

  QueueFigures(JobStore& store, WatchHub& hub, LeaseDesk& desk, const LeaseReaper& reaper, const Clock& clock)
      : store_(store), hub_(hub), desk_(desk), reaper_(reaper), clock_(clock) {}
  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  JobStore& store_;
  WatchHub& hub_;
  LeaseDesk& desk_;
  const LeaseReaper& reaper_;
  const Clock& clock_;
};

// The tenants beyond the first kMostTenants by jobs as one.
std::vector<TenantFigures> bounded(std::vector<TenantFigures> all, std::size_t most);

}  // namespace skinframe::server
