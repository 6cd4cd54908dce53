// SPDX-License-Identifier: Apache-2.0
// Each tenant has artifacts of its own, in a folder of its own:
//
//   DIR/complete, DIR/partial                  of the default tenant
//   DIR/tenants/NAME/complete, .../partial     of every other
//
// So no name that one tenant asks for can tell it what another has, also not through the length of a part
// that is kept. The price: the same mesh uploaded by two tenants lies there twice.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/artifacts/artifact_store.h"

namespace skinframe::server {

class TenantArtifacts {
 public:
  // default_tenant: whose artifacts lie in the folder itself.
  static absl::StatusOr<std::unique_ptr<TenantArtifacts>> open(const std::filesystem::path& folder,
                                                               const std::string& default_tenant,
                                                               const ArtifactLimits& limits);

  // Made when it is asked for first; lives as long as this. INVALID_ARGUMENT: no name for a folder. From any
  // thread.
  absl::StatusOr<ArtifactStore*> of(const std::string& tenant);

  // Those of all tenants that have a folder.
  absl::StatusOr<std::vector<ArtifactStore*>> all();

 private:
  TenantArtifacts(std::filesystem::path folder, std::string default_tenant, const ArtifactLimits& limits)
      : folder_(std::move(folder)), default_tenant_(std::move(default_tenant)), limits_(limits) {}

  const std::filesystem::path folder_;
  const std::string default_tenant_;
  const ArtifactLimits limits_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<ArtifactStore>> stores_;
};

}  // namespace skinframe::server
