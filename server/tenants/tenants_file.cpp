// SPDX-License-Identifier: Apache-2.0
// The file of --tenants:
//
//   {
//     "tenants": [
//       {"name": "north", "weight": 2, "most_queued": 500, "most_running": 8, "most_artifact_bytes": 50e9,
//        "identities": ["north.farm.example"], "token_sha256": ["9f86d0..."], "addresses": ["10.1.0.0/16"]}
//     ],
//     "other_tenants": {"most_queued": 50},
//     "others": "default",
//     "workers": {"identities": ["worker.farm.example"], "addresses": ["127.0.0.1", "10.9.0.0/24"]}
//   }
#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>

#include "server/tenants/tenant_directory.h"

namespace skinframe::server {
namespace {

using nlohmann::json;

template <class... Args>
absl::Status invalid(fmt::format_string<Args...> format, Args&&... args) {
  return absl::InvalidArgumentError(fmt::format(format, std::forward<Args>(args)...));
}

absl::Status only_these(const json& object, const std::string& where,
                        std::initializer_list<const char*> known) {
  if (!object.is_object()) return invalid("{} must be an object", where);
  const std::set<std::string> names(known.begin(), known.end());
  for (const auto& [key, value] : object.items())
    if (!names.contains(key)) return invalid("{} has the unknown field \"{}\"", where, key);
  return absl::OkStatus();
}

absl::StatusOr<std::vector<std::string>> texts(const json& object, const char* field,
                                               const std::string& where) {
  std::vector<std::string> found;
  if (!object.contains(field)) return found;
  if (!object[field].is_array()) return invalid("{}.{} must be a list of texts", where, field);
  for (const json& entry : object[field]) {
    if (!entry.is_string() || entry.get_ref<const std::string&>().empty())
      return invalid("{}.{} must be a list of texts", where, field);
    found.push_back(entry.get<std::string>());
  }
  return found;
}

absl::Status read_limit(const json& object, const char* field, const std::string& where,
                        std::int64_t& limit) {
  if (!object.contains(field)) return absl::OkStatus();
  const double value = object[field].is_number() ? object[field].get<double>() : -1;
  if (!(value >= 0 && value <= 9e15) || value != std::floor(value))
    return invalid("{}.{} must be a whole number, 0 or more", where, field);
  limit = static_cast<std::int64_t>(value);
  return absl::OkStatus();
}

absl::Status read_rule(const json& object, const std::string& where, TenantRule& rule) {
  if (object.contains("weight")) {
    const double weight = object["weight"].is_number() ? object["weight"].get<double>() : 0;
    if (!(weight >= 0.01 && weight <= 100)) return invalid("{}.weight must be within 0.01 .. 100", where);
    rule.weight = weight;
  }
  absl::Status status = read_limit(object, "most_queued", where, rule.most_queued);
  if (status.ok()) status = read_limit(object, "most_running", where, rule.most_running);
  if (status.ok()) status = read_limit(object, "most_artifact_bytes", where, rule.most_artifact_bytes);
  return status;
}

absl::Status read_credentials(const json& object, const std::string& where, Credentials& known_by) {
  auto identities = texts(object, "identities", where);
  if (!identities.ok()) return identities.status();
  known_by.identities = *std::move(identities);
  auto digests = texts(object, "token_sha256", where);
  if (!digests.ok()) return digests.status();
  for (const std::string& digest : *digests) {
    if (digest.size() != 64 || digest.find_first_not_of("0123456789abcdef") != std::string::npos)
      return invalid("{}.token_sha256 has an entry that is not 64 lower-case hexadecimal digits", where);
  }
  known_by.token_sha256 = *std::move(digests);
  const auto ranges = texts(object, "addresses", where);
  if (!ranges.ok()) return ranges.status();
  for (const std::string& text : *ranges) {
    auto range = AddressRange::parse(text);
    if (!range.ok()) return invalid("{}.addresses: {}", where, std::string(range.status().message()));
    known_by.addresses.push_back(*std::move(range));
  }
  return absl::OkStatus();
}

absl::Status read_tenant(const json& object, const std::string& where, TenantsConfig::Tenant& tenant) {
  absl::Status status = only_these(object, where,
                                   {"name", "weight", "most_queued", "most_running", "most_artifact_bytes",
                                    "identities", "token_sha256", "addresses"});
  if (!status.ok()) return status;
  if (object.contains("name") && object["name"].is_string()) tenant.name = object["name"].get<std::string>();
  if (!is_tenant_name(tenant.name)) return invalid("{}.name must be 1 .. 63 of [a-z0-9._-]", where);
  if (status = read_rule(object, where, tenant.rule); !status.ok()) return status;
  return read_credentials(object, where, tenant.known_by);
}

}  // namespace

absl::StatusOr<TenantsConfig> parse_tenants(const std::string& text) {
  const json file = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (file.is_discarded()) return invalid("it is not JSON");
  if (auto status = only_these(file, "the file", {"tenants", "other_tenants", "others", "workers"});
      !status.ok())
    return status;
  TenantsConfig config;
  std::set<std::string> names;
  const json tenants = file.value("tenants", json::array());
  if (!tenants.is_array()) return invalid("tenants must be a list");
  for (const json& entry : tenants) {
    TenantsConfig::Tenant tenant;
    const std::string where = fmt::format("tenants[{}]", config.tenants.size());
    if (auto status = read_tenant(entry, where, tenant); !status.ok()) return status;
    if (!names.insert(tenant.name).second) return invalid("tenant \"{}\" is there twice", tenant.name);
    config.tenants.push_back(std::move(tenant));
  }
  if (file.contains("other_tenants")) {
    const json& rule = file["other_tenants"];
    absl::Status status =
        only_these(rule, "other_tenants", {"weight", "most_queued", "most_running", "most_artifact_bytes"});
    if (status.ok()) status = read_rule(rule, "other_tenants", config.other_tenants);
    if (!status.ok()) return status;
  }
  if (file.contains("others")) {
    if (!file["others"].is_string() || !is_tenant_name(file["others"].get<std::string>()))
      return invalid("others must be a tenant's name");
    config.others = file["others"].get<std::string>();
  }
  if (!file.contains("workers"))
    return invalid("workers is missing: who may run the jobs of all tenants, and so see them");
  absl::Status status = only_these(file["workers"], "workers", {"identities", "token_sha256", "addresses"});
  if (status.ok()) status = read_credentials(file["workers"], "workers", config.workers);
  if (!status.ok()) return status;
  return config;
}

}  // namespace skinframe::server
