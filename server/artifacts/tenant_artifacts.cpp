// SPDX-License-Identifier: Apache-2.0
#include "server/artifacts/tenant_artifacts.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace skinframe::server {

absl::StatusOr<std::unique_ptr<TenantArtifacts>> TenantArtifacts::open(const std::filesystem::path& folder,
                                                                       const std::string& default_tenant,
                                                                       const ArtifactLimits& limits) {
  std::unique_ptr<TenantArtifacts> artifacts(new TenantArtifacts(folder, default_tenant, limits));
  if (auto own = artifacts->of(default_tenant); !own.ok()) return own.status();
  return artifacts;
}

absl::StatusOr<ArtifactStore*> TenantArtifacts::of(const std::string& tenant) {
  if (tenant.empty() || tenant.front() == '.' || tenant.find('/') != std::string::npos)
    return absl::InvalidArgumentError(fmt::format("\"{}\" is no tenant's name", tenant));
  const std::lock_guard lock(mutex_);
  std::unique_ptr<ArtifactStore>& store = stores_[tenant];
  if (store == nullptr) {
    auto opened =
        ArtifactStore::open(tenant == default_tenant_ ? folder_ : folder_ / "tenants" / tenant, limits_);
    if (!opened.ok()) return opened.status();
    store = *std::move(opened);
  }
  return store.get();
}

absl::StatusOr<std::vector<ArtifactStore*>> TenantArtifacts::all() {
  std::vector<std::string> names = {default_tenant_};
  std::error_code error;
  const auto folder = folder_ / "tenants";
  for (auto at = std::filesystem::directory_iterator(folder, error);
       !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    names.push_back(at->path().filename().string());
  }
  if (error && error != std::errc::no_such_file_or_directory)
    return errno_status(error.value(), folder, "list");
  std::vector<ArtifactStore*> stores;
  for (const std::string& name : names) {
    const auto store = of(name);
    if (!store.ok()) return store.status();
    stores.push_back(*store);
  }
  return stores;
}

}  // namespace skinframe::server
