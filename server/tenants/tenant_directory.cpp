// SPDX-License-Identifier: Apache-2.0
#include "server/tenants/tenant_directory.h"

#include <algorithm>
#include <utility>

#include "server/jobs/job_id.h"
#include "server/jobs/job_record.h"

namespace skinframe::server {
namespace {

template <class List>
bool has(const List& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool by_address(const Credentials& known_by, const Caller& caller) {
  return std::any_of(known_by.addresses.begin(), known_by.addresses.end(),
                     [&](const AddressRange& range) { return range.contains(caller.peer); });
}

}  // namespace

bool is_tenant_name(std::string_view name) {
  return !name.empty() && name.size() <= 63 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
         });
}

std::string tenant_of_identity(const std::string& identity) {
  std::string name = identity;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return is_tenant_name(name) ? name : "id-" + sha256_hex(identity).substr(0, 32);
}

TenantsConfig one_tenant_for_all() {
  TenantsConfig config;
  config.others = kDefaultTenant;
  config.workers_are_all = true;
  return config;
}

TenantDirectory::TenantDirectory(TenantsConfig config) { replace(std::move(config)); }

void TenantDirectory::replace(TenantsConfig config) {
  State next{std::move(config), {}};
  for (const TenantsConfig::Tenant& tenant : next.config.tenants) next.rules[tenant.name] = tenant.rule;
  auto made = std::make_shared<const State>(std::move(next));
  const std::lock_guard lock(mutex_);
  state_.swap(made);
}

std::shared_ptr<const TenantDirectory::State> TenantDirectory::current() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

absl::StatusOr<std::string> TenantDirectory::tenant_of(const Caller& caller) const {
  const auto state = current();
  const TenantsConfig& config = state->config;
  if (!caller.identity.empty()) {
    for (const auto& tenant : config.tenants)
      if (has(tenant.known_by.identities, caller.identity)) return tenant.name;
    return tenant_of_identity(caller.identity);
  }
  if (!caller.token.empty()) {
    const std::string digest = sha256_hex(caller.token);
    for (const auto& tenant : config.tenants)
      if (has(tenant.known_by.token_sha256, digest)) return tenant.name;
    if (!config.tenants.empty())
      return absl::UnauthenticatedError("the token is not one that the server knows");
  }
  for (const auto& tenant : config.tenants)
    if (by_address(tenant.known_by, caller)) return tenant.name;
  if (!config.others.empty()) return config.others;
  return absl::UnauthenticatedError(
      "the server does not know whose caller this is: give a token or a client certificate that it knows");
}

absl::Status TenantDirectory::permit_work(const Caller& caller) const {
  const auto state = current();
  if (state->config.workers_are_all) return absl::OkStatus();
  const Credentials& known = state->config.workers;
  if (!caller.identity.empty() && has(known.identities, caller.identity)) return absl::OkStatus();
  if (!caller.token.empty() && has(known.token_sha256, sha256_hex(caller.token))) return absl::OkStatus();
  if (by_address(known, caller)) return absl::OkStatus();
  return absl::PermissionDeniedError(
      "only workers may call this: name the caller's identity, token or address under \"workers\" in the "
      "server's tenants file");
}

TenantRule TenantDirectory::rule_of(const std::string& tenant) const {
  const auto state = current();
  const auto known = state->rules.find(tenant);
  return known == state->rules.end() ? state->config.other_tenants : known->second;
}

}  // namespace skinframe::server
