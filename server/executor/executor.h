// SPDX-License-Identifier: Apache-2.0
// Threads for what may block: the store waits for the disk at each commit, and gRPC has only a few callback
// threads. So handlers post their work here and no callback thread ever waits.
//
// The number of threads bounds how many commits the store can group into one. Tasks wait in a queue without a
// bound of its own: each call has at most one task here, and gRPC bounds the calls.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace skinframe::server {

class Executor {
 public:
  explicit Executor(int threads);
  ~Executor() { stop(); }
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  void post(std::function<void()> task);  // after stop: dropped

  // Runs what was posted, then joins. Call it before what the tasks use goes away.
  void stop();

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace skinframe::server
