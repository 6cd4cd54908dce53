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

TenantDirectory::TenantDirectory() {
  config_.others = kDefaultTenant;
  config_.workers_are_all = true;
}

TenantDirectory::TenantDirectory(TenantsConfig config) : config_(std::move(config)) {
  for (const TenantsConfig::Tenant& tenant : config_.tenants) rules_[tenant.name] = tenant.rule;
}

absl::StatusOr<std::string> TenantDirectory::tenant_of(const Caller& caller) const {
  if (!caller.identity.empty()) {
    for (const auto& tenant : config_.tenants)
      if (has(tenant.known_by.identities, caller.identity)) return tenant.name;
    return tenant_of_identity(caller.identity);
  }
  if (!caller.token.empty()) {
    const std::string digest = sha256_hex(caller.token);
    for (const auto& tenant : config_.tenants)
      if (has(tenant.known_by.token_sha256, digest)) return tenant.name;
    if (!config_.tenants.empty())
      return absl::UnauthenticatedError("the token is not one that the server knows");
  }
  for (const auto& tenant : config_.tenants)
    if (by_address(tenant.known_by, caller)) return tenant.name;
  if (!config_.others.empty()) return config_.others;
  return absl::UnauthenticatedError(
      "the server does not know whose caller this is: give a token or a client certificate that it knows");
}

absl::Status TenantDirectory::permit_work(const Caller& caller) const {
  if (config_.workers_are_all) return absl::OkStatus();
  const Credentials& known = config_.workers;
  if (!caller.identity.empty() && has(known.identities, caller.identity)) return absl::OkStatus();
  if (!caller.token.empty() && has(known.token_sha256, sha256_hex(caller.token))) return absl::OkStatus();
  if (by_address(known, caller)) return absl::OkStatus();
  return absl::PermissionDeniedError(
      "only workers may call this: name the caller's identity, token or address under \"workers\" in the "
      "server's tenants file");
}

const TenantRule& TenantDirectory::rule_of(const std::string& tenant) const {
  const auto known = rules_.find(tenant);
  return known == rules_.end() ? config_.other_tenants : known->second;
}

}  // namespace skinframe::server
