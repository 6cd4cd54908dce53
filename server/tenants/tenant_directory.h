// SPDX-License-Identifier: Apache-2.0
// Who is whose, and what each may take: the tenant of a caller is derived from what the connection proves of
// it, never from what it asks for.
//
// Order of proof: the identity of a verified client certificate; a token; the network address. The first rule
// that knows one of them decides. A verified identity that no rule knows is a tenant of its own name.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/tenants/address_range.h"

namespace skinframe::server {

// What is known of a caller.
struct Caller {
  std::string
      identity;       // subject alternative name, else common name, of its verified certificate; empty: none
  std::string token;  // of the metadata "authorization: Bearer TOKEN"; empty: none
  std::string peer;   // "ipv4:10.1.2.3:50000", as gRPC names it
};

// By what a caller is known.
struct Credentials {
  std::vector<std::string> identities;
  std::vector<std::string> token_sha256;  // 64 lower-case hexadecimal digits: the file holds no secrets
  std::vector<AddressRange> addresses;
};

// What a tenant may take. No limit: the largest number.
struct TenantRule {
  static constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();
  double weight = 1;  // its share of the workers, relative to the others that wait; 0.01 .. 100
  std::int64_t most_queued = kNoLimit;
  std::int64_t most_running = kNoLimit;
  std::int64_t most_artifact_bytes = kNoLimit;
};

struct TenantsConfig {
  struct Tenant {
    std::string name;
    TenantRule rule;
    Credentials known_by;
  };
  std::vector<Tenant> tenants;
  TenantRule other_tenants;  // the rule of those that are not in the list
  std::string others;        // whose callers are that nothing is known of; empty: they are refused
  Credentials workers;       // who may call WorkerService
  bool workers_are_all = false;
};

// Everybody is the default tenant, without limits, and everybody may work.
TenantsConfig one_tenant_for_all();

// From any thread. A call is answered by one configuration: the one before an exchange or the one after it.
class TenantDirectory {
 public:
  explicit TenantDirectory(TenantsConfig config = one_tenant_for_all());

  // The next calls are answered by this one.
  void replace(TenantsConfig config);

  // UNAUTHENTICATED: nobody knows the caller.
  absl::StatusOr<std::string> tenant_of(const Caller& caller) const;

  // PERMISSION_DENIED: not a worker.
  absl::Status permit_work(const Caller& caller) const;

  TenantRule rule_of(const std::string& tenant) const;

 private:
  struct State {
    TenantsConfig config;
    std::map<std::string, TenantRule> rules;
  };
  std::shared_ptr<const State> current() const;

  mutable std::mutex mutex_;
  std::shared_ptr<const State> state_;  // guarded by mutex_
};

// [a-z0-9._-]{1,63}, and no dot in front.
bool is_tenant_name(std::string_view name);

// The tenant that an identity is by itself: its name in lower case where that is a tenant's name, else a name
// made of its hash.
std::string tenant_of_identity(const std::string& identity);

// Reads the text of --tenants; tenants_file.cpp has an example. INVALID_ARGUMENT "FILE:LINE: FIELD: what is
// wrong".
absl::StatusOr<TenantsConfig> parse_tenants(const std::string& json, const std::string& file);

}  // namespace skinframe::server
