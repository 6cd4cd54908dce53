// SPDX-License-Identifier: Apache-2.0
// Keeps the tenants in force in step with the operator's file.
//
// A file that is not good as a whole changes nothing: who was whose before stays in force, and the log says
// file, line and field. Jobs keep the tenant that they were submitted for.
#pragma once

#include "server/app/path_watch.h"
#include "server/tenants/tenant_directory.h"

namespace skinframe::server {

// INVALID_ARGUMENT "FILE:LINE: FIELD: what is wrong".
absl::StatusOr<TenantsConfig> read_tenants(const std::filesystem::path& file);

class TenantsWatch final : public PathWatch {
 public:
  TenantsWatch(std::filesystem::path file, TenantDirectory& tenants, Milliseconds every)
      : PathWatch(std::move(file), every), tenants_(tenants) {}
  std::string_view name() const override { return "tenants watch"; }

 private:
  void read() override;

  TenantDirectory& tenants_;
};

}  // namespace skinframe::server
