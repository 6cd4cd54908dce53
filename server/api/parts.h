// SPDX-License-Identifier: Apache-2.0
// What the RPC handlers delegate to. Owned by app/server.h; outlives all calls.
#pragma once

#include <cstdint>

#include "server/artifacts/tenant_artifacts.h"
#include "server/catalog/live_catalog.h"
#include "server/events/event_pages.h"
#include "server/events/watch_hub.h"
#include "server/executor/executor.h"
#include "server/jobs/attempt_policy.h"
#include "server/jobs/clock.h"
#include "server/jobs/job_id.h"
#include "server/leases/lease_desk.h"
#include "server/store/job_store.h"
#include "server/tenants/tenant_directory.h"

namespace skinframe::server {

struct Parts {
  JobStore& store;
  TenantArtifacts& artifacts;
  const TenantDirectory& tenants;
  const LiveCatalog& catalog;
  WatchHub& hub;
  EventPages& pages;
  LeaseDesk& desk;
  Executor& executor;
  const Clock& clock;
  IdGenerator& ids;
  AttemptPolicy policy;
  std::int64_t queue_limit;
};

}  // namespace skinframe::server
