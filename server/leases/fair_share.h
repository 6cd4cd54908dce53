// SPDX-License-Identifier: Apache-2.0
// Between tenants: whose turn it is when a worker asks. Whoever has the fewest running jobs for its weight
// comes first; among equals, whoever has been given the fewest jobs for its weight (stride scheduling), so
// that one worker alone serves all in turn too. A tenant at its quota of running jobs is passed over.
//
//   first by   running / weight      what it holds now
//   then by    pass                  rises by 1 / weight with each job given
//
// A tenant that had nothing queued for a while comes back with at most one job's credit: nobody saves up
// turns. The passes are this process's own: replicas share fairly each for itself, and a restart forgets
// them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "server/store/job_store.h"
#include "server/tenants/tenant_directory.h"

namespace skinframe::server {

// One thread at a time.
class FairShare {
 public:
  explicit FairShare(const TenantDirectory& tenants) : tenants_(tenants) {}

  // Whose jobs to look at, in this order.
  std::vector<std::string> order(const std::vector<TenantLoad>& waiting);

  // The tenant was given a job.
  void leased(const std::string& tenant);

 private:
  const TenantDirectory& tenants_;
  std::map<std::string, double> pass_;
  double now_ = 0;  // the pass of whoever was served last
};

}  // namespace skinframe::server
