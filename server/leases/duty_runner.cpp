// SPDX-License-Identifier: Apache-2.0
#include "server/leases/duty_runner.h"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

namespace skinframe::server {

DutyRunner::DutyRunner(const Clock& clock, std::vector<Duty*> duties, Milliseconds pause)
    : clock_(clock), duties_(std::move(duties)), pause_(pause), thread_([this] { run(); }) {}

DutyRunner::~DutyRunner() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_all();
  thread_.join();
}

void DutyRunner::run() {
  std::unique_lock lock(mutex_);
  while (!stop_.wait_for(lock, pause_, [this] { return stopping_; })) {
    lock.unlock();
    for (Duty* duty : duties_) {
      const absl::Status status = duty->run_once(clock_.now());
      if (!status.ok()) spdlog::error("{}: {}", duty->name(), std::string(status.message()));
    }
    lock.lock();
  }
}

}  // namespace skinframe::server
