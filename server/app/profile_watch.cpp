// SPDX-License-Identifier: Apache-2.0
#include "server/app/profile_watch.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <set>

namespace skinframe::server {

namespace fs = std::filesystem;

ProfileWatch::ProfileWatch(fs::path folder, LiveCatalog& catalog, Milliseconds every)
    : folder_(std::move(folder)), catalog_(catalog), every_(every), read_(stamp()), seen_(read_) {}

std::string ProfileWatch::stamp() const {
  std::set<std::string> files;
  std::error_code error;
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;  // a file that goes while we look differs at the next look
    files.insert(fmt::format("{} {} {}\n", at->path().filename().string(), at->file_size(ignored),
                             at->last_write_time(ignored).time_since_epoch().count()));
  }
  std::string all = error ? error.message() : "";
  for (const std::string& file : files) all += file;
  return all;
}

absl::Status ProfileWatch::run_once(Time now) {
  const bool asked = asked_.exchange(false);
  if (!asked && now >= looked_ && now - looked_ < every_) return absl::OkStatus();
  looked_ = now;
  const std::string here = stamp();
  // A change is read once the folder has kept still for a look: whoever copies files in is done by then.
  const bool still = here == seen_;
  seen_ = here;
  if (!asked && (here == read_ || !still)) return absl::OkStatus();
  read_ = here;
  auto loaded = load_catalog(folder_);
  if (!loaded.ok()) {
    spdlog::error("profiles: {}; the profiles before stay in force", std::string(loaded.status().message()));
    return absl::OkStatus();
  }
  const auto printers = loaded->printers().size(), materials = loaded->materials().size();
  catalog_.replace(*std::move(loaded));
  spdlog::info("profiles: {} read, {} printers and {} materials are known", folder_.string(), printers,
               materials);
  return absl::OkStatus();
}

}  // namespace skinframe::server
