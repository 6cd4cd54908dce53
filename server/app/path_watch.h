// SPDX-License-Identifier: Apache-2.0
// Reads a file or folder of the operator's again when it has changed: looks at it now and then, and at once
// when asked to (SIGHUP). What reading means, and that something bad changes nothing, is the derived class's.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "server/leases/duty.h"

namespace skinframe::server {

class PathWatch : public Duty {
 public:
  // As it is now counts as read. Looks when `every` has passed since the last look.
  PathWatch(std::filesystem::path path, Milliseconds every);
  absl::Status run_once(Time now) final;

  void reload() { asked_ = true; }  // by the next round; from any thread

 protected:
  virtual void read() = 0;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::string stamp() const;  // names, sizes and times of change of the file, or of the folder's files

  const std::filesystem::path path_;
  const Milliseconds every_;
  Time looked_{};
  std::string read_;  // the stamp of what was read last, good or bad
  std::string seen_;  // the stamp at the last look
  std::atomic<bool> asked_ = false;
};

}  // namespace skinframe::server
