// SPDX-License-Identifier: Apache-2.0
#include "server/leases/fair_share.h"

#include <algorithm>
#include <tuple>

namespace skinframe::server {

std::vector<std::string> FairShare::order(const std::vector<TenantLoad>& waiting) {
  std::vector<std::tuple<double, double, std::string>> turns;  // running / weight, pass, name
  for (const TenantLoad& load : waiting) {
    const TenantRule rule = tenants_.rule_of(load.tenant);
    if (load.running >= rule.most_running) continue;
    double& pass = pass_.try_emplace(load.tenant, now_).first->second;
    pass = std::max(pass, now_ - 1 / rule.weight);
    turns.emplace_back(static_cast<double>(load.running) / rule.weight, pass, load.tenant);
  }
  std::sort(turns.begin(), turns.end());
  std::vector<std::string> order;
  for (const auto& [held, pass, tenant] : turns) order.push_back(tenant);
  return order;
}

void FairShare::leased(const std::string& tenant) {
  double& pass = pass_.try_emplace(tenant, now_).first->second;
  now_ = std::max(now_, pass);
  pass += 1 / tenants_.rule_of(tenant).weight;
}

}  // namespace skinframe::server
