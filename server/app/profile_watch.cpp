// SPDX-License-Identifier: Apache-2.0
#include "server/app/profile_watch.h"

#include <spdlog/spdlog.h>

namespace skinframe::server {

void ProfileWatch::read() {
  auto loaded = load_catalog(path());
  if (!loaded.ok()) {
    spdlog::error("profiles: {}; the profiles before stay in force", std::string(loaded.status().message()));
    return;
  }
  const auto printers = loaded->printers().size(), materials = loaded->materials().size();
  catalog_.replace(*std::move(loaded));
  spdlog::info("profiles: {} read, {} printers and {} materials are known", path().string(), printers,
               materials);
}

}  // namespace skinframe::server
