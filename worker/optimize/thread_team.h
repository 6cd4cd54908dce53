// SPDX-License-Identifier: GPL-3.0-or-later
// A few threads that share the tasks of one call after another. Which thread takes which task is left to
// chance: tasks must not depend on it.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace skinframe {

class ThreadTeam {
 public:
  explicit ThreadTeam(int threads);  // the caller's own among them; at least 1
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(threads_.size()) + 1; }
  // act(0) .. act(count - 1), each once; returns when all are done. `act` must not throw. Not to be nested.
  void run(int count, const std::function<void(int)>& act);

 private:
  void help();
  void take_tasks(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  const std::function<void(int)>* act_ = nullptr;
  int next_ = 0, count_ = 0, unfinished_ = 0;
  bool closing_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace skinframe
