// SPDX-License-Identifier: Apache-2.0
#include "server/tenants/tenant_directory.h"

#include <gtest/gtest.h>

#include "server/jobs/job_id.h"

namespace skinframe::server {
namespace {

TenantDirectory farm(const std::string& others = "") {
  TenantsConfig config;
  TenantRule rule;
  rule.most_queued = 5;
  config.tenants.push_back({"north", rule, {{"n.example"}, {sha256_hex("secret")}, {}}});
  config.tenants.push_back({"lab", {}, {{}, {}, {*AddressRange::parse("10.1.0.0/16")}}});
  config.other_tenants.most_queued = 2;
  config.others = others;
  config.workers = {{"worker.example"}, {}, {*AddressRange::parse("127.0.0.1")}};
  return TenantDirectory(config);
}

TEST(TenantDirectory, WithoutAFileEverybodyIsTheDefaultTenantAndMayWork) {
  const TenantDirectory directory;
  EXPECT_EQ(*directory.tenant_of({"", "any token", "ipv4:8.8.8.8:1"}), "default");
  EXPECT_TRUE(directory.permit_work({}).ok());
  EXPECT_EQ(directory.rule_of("default").most_queued, TenantRule::kNoLimit);
}

TEST(TenantDirectory, TheStrongestProofDecides) {
  const auto directory = farm();
  EXPECT_EQ(*directory.tenant_of({"n.example", "", "ipv4:10.1.2.3:1"}), "north");
  EXPECT_EQ(*directory.tenant_of({"", "secret", "ipv4:10.1.2.3:1"}), "north");
  EXPECT_EQ(*directory.tenant_of({"", "", "ipv4:10.1.2.3:1"}), "lab");
  EXPECT_EQ(*directory.tenant_of({"other.example", "secret", ""}), "other.example") << "not the token's";
}

TEST(TenantDirectory, AWrongTokenIsRefusedAlsoWhereTheAddressWouldDo) {
  EXPECT_TRUE(absl::IsUnauthenticated(farm("default").tenant_of({"", "guess", "ipv4:10.1.2.3:1"}).status()));
}

TEST(TenantDirectory, WhoIsNotKnownIsRefusedOrTheOthersTenant) {
  EXPECT_TRUE(absl::IsUnauthenticated(farm().tenant_of({"", "", "ipv4:8.8.8.8:1"}).status()));
  EXPECT_EQ(*farm("guests").tenant_of({"", "", "ipv4:8.8.8.8:1"}), "guests");
}

TEST(TenantDirectory, OnlyThoseNamedMayWork) {
  const auto directory = farm();
  EXPECT_TRUE(directory.permit_work({"worker.example", "", "ipv4:8.8.8.8:1"}).ok());
  EXPECT_TRUE(directory.permit_work({"", "", "ipv4:127.0.0.1:1"}).ok());
  EXPECT_TRUE(absl::IsPermissionDenied(directory.permit_work({"n.example", "secret", "ipv4:8.8.8.8:1"})));
}

TEST(TenantDirectory, RulesAreTheTenantsOwnAndOneForAllOthers) {
  EXPECT_EQ(farm().rule_of("north").most_queued, 5);
  EXPECT_EQ(farm().rule_of("somebody").most_queued, 2);
}

TEST(TenantName, AnIdentityBecomesANameThatIsSafeAsAFolder) {
  EXPECT_EQ(tenant_of_identity("Farm.Example"), "farm.example");
  const std::string uri = tenant_of_identity("spiffe://farm/../etc");
  EXPECT_TRUE(is_tenant_name(uri)) << uri;
  EXPECT_NE(uri, tenant_of_identity("spiffe://farm/../var"));
  for (const char* bad : {"", ".", "..", "a/b", "A", "a b"}) EXPECT_FALSE(is_tenant_name(bad)) << bad;
  EXPECT_FALSE(is_tenant_name(std::string(64, 'a')));
}

TEST(TenantDirectory, AnExchangeHoldsFromTheNextCallOn) {
  TenantDirectory directory;
  TenantsConfig closed;
  closed.tenants.push_back({"north", {}, {{"n.example"}, {}, {}}});
  closed.tenants[0].rule.most_queued = 7;
  directory.replace(closed);
  EXPECT_EQ(*directory.tenant_of({"n.example", "", ""}), "north");
  EXPECT_TRUE(absl::IsUnauthenticated(directory.tenant_of({"", "", "ipv4:10.1.2.3:1"}).status()));
  EXPECT_TRUE(absl::IsPermissionDenied(directory.permit_work({})));
  EXPECT_EQ(directory.rule_of("north").most_queued, 7);
}

}  // namespace
}  // namespace skinframe::server
