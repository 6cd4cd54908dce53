// SPDX-License-Identifier: Apache-2.0
#include "client/call/clock.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace skinframe::client {
namespace {

class SystemClock final : public Clock {
 public:
  std::chrono::steady_clock::time_point now() override { return std::chrono::steady_clock::now(); }
  bool wait(std::chrono::milliseconds delay, const std::stop_token& stop) override {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    wake.wait_for(lock, stop, delay, [] { return false; });
    return !stop.stop_requested();
  }
};

class ConnectingClock final : public Clock {
 public:
  explicit ConnectingClock(std::shared_ptr<grpc::Channel> channel) : channel_(std::move(channel)) {}

  std::chrono::steady_clock::time_point now() override { return std::chrono::steady_clock::now(); }
  bool wait(std::chrono::milliseconds delay, const std::stop_token& stop) override {
    const auto end = now() + delay;
    for (auto at = now(); at < end && !stop.stop_requested(); at = now()) {
      const auto part = std::min<std::chrono::steady_clock::duration>(end - at, kPart);
      channel_->WaitForStateChange(channel_->GetState(true), std::chrono::system_clock::now() + part);
    }
    return !stop.stop_requested();
  }

 private:
  static constexpr std::chrono::milliseconds kPart{100};  // a stop is heard of within it

  std::shared_ptr<grpc::Channel> channel_;
};

}  // namespace

std::shared_ptr<Clock> connecting_clock(std::shared_ptr<grpc::Channel> channel) {
  return std::make_shared<ConnectingClock>(std::move(channel));
}

Clock& system_clock() {
  static SystemClock clock;
  return clock;
}

}  // namespace skinframe::client
