// SPDX-License-Identifier: Apache-2.0
// Keeps the catalogue in force in step with the operator's profile folder: looks at the folder now and then,
// and at once when it is asked to (SIGHUP).
//
// A folder that cannot be read as a whole changes nothing: the catalogue before stays in force, and the log
// says file, line and field. Jobs have copies of their profiles and do not notice any of it.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "server/catalog/live_catalog.h"
#include "server/leases/duty.h"

namespace skinframe::server {

class ProfileWatch final : public Duty {
 public:
  // The folder as it is now counts as read. Looks when `every` has passed since the last look.
  ProfileWatch(std::filesystem::path folder, LiveCatalog& catalog, Milliseconds every);
  std::string_view name() const override { return "profile watch"; }
  absl::Status run_once(Time now) override;

  void reload() { asked_ = true; }  // by the next round; from any thread

 private:
  std::string stamp() const;  // names, sizes and times of change of the folder's files

  const std::filesystem::path folder_;
  LiveCatalog& catalog_;
  const Milliseconds every_;
  Time looked_{};
  std::string read_;  // the stamp of what was read last, good or bad
  std::string seen_;  // the stamp at the last look
  std::atomic<bool> asked_ = false;
};

}  // namespace skinframe::server
