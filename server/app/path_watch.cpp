// SPDX-License-Identifier: Apache-2.0
#include "server/app/path_watch.h"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace skinframe::server {

namespace fs = std::filesystem;

namespace {

std::string stamp_of(const fs::path& file) {
  std::error_code ignored;  // a file that goes while we look differs at the next look
  return fmt::format("{} {} {}\n", file.filename().string(), fs::file_size(file, ignored),
                     fs::last_write_time(file, ignored).time_since_epoch().count());
}

}  // namespace

PathWatch::PathWatch(fs::path path, Milliseconds every)
    : path_(std::move(path)), every_(every), read_(stamp()), seen_(read_) {}

std::string PathWatch::stamp() const {
  std::error_code error;
  if (!fs::is_directory(path_, error)) return error ? error.message() : stamp_of(path_);
  std::set<std::string> files;
  for (fs::directory_iterator at(path_, error), end; !error && at != end; at.increment(error))
    files.insert(stamp_of(at->path()));
  std::string all = error ? error.message() : "";
  for (const std::string& file : files) all += file;
  return all;
}

absl::Status PathWatch::run_once(Time now) {
  const bool asked = asked_.exchange(false);
  if (!asked && now >= looked_ && now - looked_ < every_) return absl::OkStatus();
  looked_ = now;
  const std::string here = stamp();
  // A change is read once it has kept still for a look: whoever copies files in is done by then.
  const bool still = here == seen_;
  seen_ = here;
  if (!asked && (here == read_ || !still)) return absl::OkStatus();
  read_ = here;
  read();
  return absl::OkStatus();
}

}  // namespace skinframe::server
