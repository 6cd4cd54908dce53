// SPDX-License-Identifier: Apache-2.0
#include "server/app/tenants_watch.h"

#include <spdlog/spdlog.h>

#include "server/app/data_folder.h"

namespace skinframe::server {

absl::StatusOr<TenantsConfig> read_tenants(const std::filesystem::path& file) {
  const auto text = read_whole_file(file);
  if (!text.ok()) return text.status();
  return parse_tenants(*text, file.string());
}

void TenantsWatch::read() {
  auto config = read_tenants(path());
  if (!config.ok()) {
    spdlog::error("tenants: {}; the tenants before stay in force", std::string(config.status().message()));
    return;
  }
  const auto named = config->tenants.size();
  tenants_.replace(*std::move(config));
  spdlog::info("tenants: {} read, {} are named", path().string(), named);
}

}  // namespace skinframe::server
