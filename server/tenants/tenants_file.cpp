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
#include <set>

#include "server/lined_json/lined_json.h"
#include "server/tenants/tenant_directory.h"

namespace skinframe::server {
namespace {

using nlohmann::json;

class Reader {
 public:
  Reader(const LinedJson& document, const std::string& file) : document_(document), file_(file) {}

  absl::StatusOr<TenantsConfig> read() const;

 private:
  // "FILE:LINE: FIELD: what"
  template <class... Args>
  absl::Status wrong(const std::string& path, fmt::format_string<Args...> format, Args&&... args) const {
    return absl::InvalidArgumentError(fmt::format("{}:{}: {}: {}", file_, document_.line(path),
                                                  path.empty() ? "the file" : path,
                                                  fmt::format(format, std::forward<Args>(args)...)));
  }
  static std::string in(const std::string& where, const std::string& field) {
    return where.empty() ? field : where + "." + field;
  }

  absl::Status only_these(const json& object, const std::string& where,
                          std::initializer_list<const char*> known) const;
  absl::StatusOr<std::vector<std::string>> texts(const json& object, const std::string& where,
                                                 const char* field) const;
  absl::Status read_limit(const json& object, const std::string& where, const char* field,
                          std::int64_t& limit) const;
  absl::Status read_rule(const json& object, const std::string& where, TenantRule& rule) const;
  absl::Status read_credentials(const json& object, const std::string& where, Credentials& known_by) const;
  absl::Status read_tenant(const json& object, const std::string& where, TenantsConfig::Tenant& tenant) const;
  absl::Status read_tenants(const json& file, TenantsConfig& config) const;

  const LinedJson& document_;
  const std::string& file_;
};

absl::Status Reader::only_these(const json& object, const std::string& where,
                                std::initializer_list<const char*> known) const {
  if (!object.is_object()) return wrong(where, "must be an object");
  const std::set<std::string> names(known.begin(), known.end());
  for (const auto& [key, value] : object.items())
    if (!names.contains(key))
      return wrong(in(where, key), "is an unknown field; known: {}", fmt::join(known, ", "));
  return absl::OkStatus();
}

absl::StatusOr<std::vector<std::string>> Reader::texts(const json& object, const std::string& where,
                                                       const char* field) const {
  std::vector<std::string> found;
  if (!object.contains(field)) return found;
  if (!object[field].is_array()) return wrong(in(where, field), "must be a list of texts");
  for (const json& entry : object[field]) {
    if (!entry.is_string() || entry.get_ref<const std::string&>().empty())
      return wrong(fmt::format("{}[{}]", in(where, field), found.size()), "must be a text");
    found.push_back(entry.get<std::string>());
  }
  return found;
}

absl::Status Reader::read_limit(const json& object, const std::string& where, const char* field,
                                std::int64_t& limit) const {
  if (!object.contains(field)) return absl::OkStatus();
  const double value = object[field].is_number() ? object[field].get<double>() : -1;
  if (!(value >= 0 && value <= 9e15) || value != std::floor(value))
    return wrong(in(where, field), "must be a whole number, 0 or more");
  limit = static_cast<std::int64_t>(value);
  return absl::OkStatus();
}

absl::Status Reader::read_rule(const json& object, const std::string& where, TenantRule& rule) const {
  if (object.contains("weight")) {
    const double weight = object["weight"].is_number() ? object["weight"].get<double>() : 0;
    if (!(weight >= 0.01 && weight <= 100)) return wrong(in(where, "weight"), "must be within 0.01 .. 100");
    rule.weight = weight;
  }
  absl::Status status = read_limit(object, where, "most_queued", rule.most_queued);
  if (status.ok()) status = read_limit(object, where, "most_running", rule.most_running);
  if (status.ok()) status = read_limit(object, where, "most_artifact_bytes", rule.most_artifact_bytes);
  return status;
}

absl::Status Reader::read_credentials(const json& object, const std::string& where,
                                      Credentials& known_by) const {
  auto identities = texts(object, where, "identities");
  if (!identities.ok()) return identities.status();
  known_by.identities = *std::move(identities);
  auto digests = texts(object, where, "token_sha256");
  if (!digests.ok()) return digests.status();
  for (std::size_t i = 0; i < digests->size(); ++i) {
    const std::string& digest = (*digests)[i];
    if (digest.size() != 64 || digest.find_first_not_of("0123456789abcdef") != std::string::npos)
      return wrong(fmt::format("{}[{}]", in(where, "token_sha256"), i),
                   "must be 64 lower-case hexadecimal digits");
  }
  known_by.token_sha256 = *std::move(digests);
  const auto ranges = texts(object, where, "addresses");
  if (!ranges.ok()) return ranges.status();
  for (const std::string& text : *ranges) {
    auto range = AddressRange::parse(text);
    if (!range.ok())
      return wrong(fmt::format("{}[{}]", in(where, "addresses"), known_by.addresses.size()), "{}",
                   std::string(range.status().message()));
    known_by.addresses.push_back(*std::move(range));
  }
  return absl::OkStatus();
}

absl::Status Reader::read_tenant(const json& object, const std::string& where,
                                 TenantsConfig::Tenant& tenant) const {
  absl::Status status = only_these(object, where,
                                   {"name", "weight", "most_queued", "most_running", "most_artifact_bytes",
                                    "identities", "token_sha256", "addresses"});
  if (!status.ok()) return status;
  if (object.contains("name") && object["name"].is_string()) tenant.name = object["name"].get<std::string>();
  if (!is_tenant_name(tenant.name)) return wrong(in(where, "name"), "must be 1 .. 63 of [a-z0-9._-]");
  if (status = read_rule(object, where, tenant.rule); !status.ok()) return status;
  return read_credentials(object, where, tenant.known_by);
}

absl::Status Reader::read_tenants(const json& file, TenantsConfig& config) const {
  if (!file.contains("tenants")) return absl::OkStatus();
  if (!file["tenants"].is_array()) return wrong("tenants", "must be a list");
  std::set<std::string> names;
  for (const json& entry : file["tenants"]) {
    TenantsConfig::Tenant tenant;
    const std::string where = fmt::format("tenants[{}]", config.tenants.size());
    if (auto status = read_tenant(entry, where, tenant); !status.ok()) return status;
    if (!names.insert(tenant.name).second)
      return wrong(in(where, "name"), "tenant \"{}\" is there twice", tenant.name);
    config.tenants.push_back(std::move(tenant));
  }
  return absl::OkStatus();
}

absl::StatusOr<TenantsConfig> Reader::read() const {
  const json& file = document_.value;
  TenantsConfig config;
  absl::Status status = only_these(file, "", {"tenants", "other_tenants", "others", "workers"});
  if (status.ok()) status = read_tenants(file, config);
  if (status.ok() && file.contains("other_tenants")) {
    const json& rule = file["other_tenants"];
    status =
        only_these(rule, "other_tenants", {"weight", "most_queued", "most_running", "most_artifact_bytes"});
    if (status.ok()) status = read_rule(rule, "other_tenants", config.other_tenants);
  }
  if (!status.ok()) return status;
  if (file.contains("others")) {
    if (!file["others"].is_string() || !is_tenant_name(file["others"].get<std::string>()))
      return wrong("others", "must be a tenant's name");
    config.others = file["others"].get<std::string>();
  }
  if (!file.contains("workers"))
    return wrong("workers", "is missing: who may run the jobs of all tenants, and so see them");
  status = only_these(file["workers"], "workers", {"identities", "token_sha256", "addresses"});
  if (status.ok()) status = read_credentials(file["workers"], "workers", config.workers);
  if (!status.ok()) return status;
  return config;
}

}  // namespace

absl::StatusOr<TenantsConfig> parse_tenants(const std::string& text, const std::string& file) {
  const auto document = parse_lined_json(text, file);
  if (!document.ok()) return document.status();
  return Reader(*document, file).read();
}

}  // namespace skinframe::server
