// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/tenants/tenant_directory.h"

namespace skinframe::server {
namespace {

void expect_refused(const std::string& text, const std::string& names) {
  const auto config = parse_tenants(text, "tenants.json");
  ASSERT_FALSE(config.ok()) << text;
  EXPECT_NE(config.status().message().find(names), absl::string_view::npos) << config.status();
}

TEST(TenantsFile, SaysAllThatARuleHas) {
  const auto config = parse_tenants(R"({
    "tenants": [{"name": "north", "weight": 2, "most_queued": 500, "most_running": 8,
                 "most_artifact_bytes": 5e10, "identities": ["n"], "addresses": ["10.0.0.0/8", "unix"]}],
    "other_tenants": {"weight": 0.5, "most_queued": 50}, "others": "guests",
    "workers": {"identities": ["w"]}})",
                                    "tenants.json");
  ASSERT_TRUE(config.ok()) << config.status();
  ASSERT_EQ(config->tenants.size(), 1u);
  const auto& north = config->tenants[0];
  EXPECT_EQ(north.rule.weight, 2);
  EXPECT_EQ(north.rule.most_running, 8);
  EXPECT_EQ(north.rule.most_artifact_bytes, 50'000'000'000);
  EXPECT_EQ(north.known_by.addresses.size(), 2u);
  EXPECT_EQ(config->other_tenants.most_queued, 50);
  EXPECT_EQ(config->other_tenants.most_running, TenantRule::kNoLimit);
  EXPECT_EQ(config->others, "guests");
}

TEST(TenantsFile, WhatIsWrongIsNamedWithItsPlace) {
  expect_refused("{", "JSON");
  expect_refused("[]", "object");
  expect_refused(R"({"tenants": []})", "tenants.json:1: workers: is missing");
  expect_refused(R"({"workers": {}, "tenats": []})", "tenats");
  expect_refused(R"({"workers": {}, "tenants": [{"name": "a"}, {"name": "a"}]})", "twice");
  expect_refused(R"({"workers": {}, "tenants": [{"name": "a", "weight": 0}]})", "tenants[0].weight: must be");
  expect_refused(R"({"workers": {}, "tenants": [{"name": "a", "most_queued": -1}]})", "most_queued");
  expect_refused(R"({"workers": {}, "tenants": [{"name": "a", "most_queued": 1.5}]})", "most_queued");
  expect_refused(R"({"workers": {}, "tenants": [{"name": "a", "token_sha256": ["secret"]}]})",
                 "token_sha256");
  expect_refused(R"({"workers": {"addresses": ["10.0.0.0/99"]}})", "workers.addresses[0]");
  expect_refused(R"({"workers": {}, "others": "Not A Name"})", "others");
  expect_refused(R"({"workers": {}, "others": "a", "others": "b"})", "others");
  expect_refused("{\n\"workers\": {},\n\"tenants\": [\n{\"name\": \"a\",\n\"most_queued\": \"many\"}]}",
                 "tenants.json:5: tenants[0].most_queued: must be a whole number");
}

}  // namespace
}  // namespace skinframe::server
