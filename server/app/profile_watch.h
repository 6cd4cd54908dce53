// SPDX-License-Identifier: Apache-2.0
// Keeps the catalogue in force in step with the operator's profile folder.
//
// A folder that cannot be read as a whole changes nothing: the catalogue before stays in force, and the log
// says file, line and field. Jobs have copies of their profiles and do not notice any of it.
#pragma once

#include "server/app/path_watch.h"
#include "server/catalog/live_catalog.h"

namespace skinframe::server {

class ProfileWatch final : public PathWatch {
 public:
  ProfileWatch(std::filesystem::path folder, LiveCatalog& catalog, Milliseconds every)
      : PathWatch(std::move(folder), every), catalog_(catalog) {}
  std::string_view name() const override { return "profile watch"; }

 private:
  void read() override;

  LiveCatalog& catalog_;
};

}  // namespace skinframe::server
