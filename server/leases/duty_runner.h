// SPDX-License-Identifier: Apache-2.0
// One thread that runs all duties, round after round.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "server/leases/duty.h"

namespace skinframe::server {

class DutyRunner {
 public:
  // clock and duties outlive the runner.
  DutyRunner(const Clock& clock, std::vector<Duty*> duties, Milliseconds pause);
  ~DutyRunner();  // lets the round end
  DutyRunner(const DutyRunner&) = delete;
  DutyRunner& operator=(const DutyRunner&) = delete;

 private:
  void run();

  const Clock& clock_;
  const std::vector<Duty*> duties_;
  const Milliseconds pause_;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace skinframe::server
