// SPDX-License-Identifier: Apache-2.0
#include "server/leases/fair_share.h"

#include <gtest/gtest.h>

namespace skinframe::server {
namespace {

TenantDirectory with_rules(const std::map<std::string, TenantRule>& rules) {
  TenantsConfig config;
  for (const auto& [name, rule] : rules) config.tenants.push_back({name, rule, {}});
  return TenantDirectory(config);
}

TenantRule weight(double w) {
  TenantRule rule;
  rule.weight = w;
  return rule;
}

// How often each of the tenants, all waiting and none running when asked, is served in so many turns.
std::map<std::string, int> turns(FairShare& share, const std::vector<std::string>& waiting, int count) {
  std::map<std::string, int> served;
  std::vector<TenantLoad> loads;
  for (const std::string& tenant : waiting) loads.push_back({tenant, 0});
  for (int i = 0; i < count; ++i) {
    const std::string first = share.order(loads).front();
    share.leased(first);
    ++served[first];
  }
  return served;
}

TEST(FairShare, WhoHasTheFewestRunningForItsWeightComesFirst) {
  const auto rules = with_rules({{"heavy", weight(4)}});
  FairShare share(rules);
  EXPECT_EQ(share.order({{"a", 2}, {"b", 1}, {"heavy", 3}}), (std::vector<std::string>{"heavy", "b", "a"}));
}

TEST(FairShare, OneWorkerServesAllByTheirWeights) {
  const auto rules = with_rules({{"double", weight(2)}, {"half", weight(0.5)}});
  FairShare share(rules);
  const auto served = turns(share, {"double", "half", "one"}, 700);
  EXPECT_NEAR(served.at("double"), 400, 2);
  EXPECT_NEAR(served.at("one"), 200, 2);
  EXPECT_NEAR(served.at("half"), 100, 2);
}

TEST(FairShare, NobodySavesUpTurnsWhileIdle) {
  const TenantDirectory everybody;
  FairShare share(everybody);
  turns(share, {"idle", "busy"}, 2);
  turns(share, {"busy"}, 1000);
  const auto served = turns(share, {"idle", "busy"}, 10);
  EXPECT_GE(served.at("busy"), 4);
  EXPECT_GE(served.at("idle"), 4);
}

TEST(FairShare, AThousandJobsOfOneDoNotHoldUpTheFirstOfAnother) {
  const TenantDirectory everybody;
  FairShare share(everybody);
  turns(share, {"a"}, 1000);
  EXPECT_EQ(share.order({{"a", 0}, {"z", 0}}).front(), "z");
}

TEST(FairShare, AtItsQuotaOfRunningJobsATenantIsPassedOver) {
  TenantRule two;
  two.most_running = 2;
  const auto rules = with_rules({{"small", two}});
  FairShare share(rules);
  EXPECT_EQ(share.order({{"small", 2}, {"other", 50}}), (std::vector<std::string>{"other"}));
  EXPECT_EQ(share.order({{"small", 1}, {"other", 50}}), (std::vector<std::string>{"small", "other"}));
}

}  // namespace
}  // namespace skinframe::server
