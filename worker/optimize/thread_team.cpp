// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/thread_team.h"

namespace skinframe {

ThreadTeam::ThreadTeam(int threads) {
  for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { help(); });
}

ThreadTeam::~ThreadTeam() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadTeam::run(int count, const std::function<void(int)>& act) {
  if (threads_.empty() || count <= 1) {
    for (int i = 0; i < count; ++i) act(i);
    return;
  }
  std::unique_lock lock(mutex_);
  act_ = &act;
  next_ = 0;
  count_ = unfinished_ = count;
  wake_.notify_all();
  take_tasks(lock);
  done_.wait(lock, [this] { return unfinished_ == 0; });
}

void ThreadTeam::help() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return closing_ || next_ < count_; });
    if (closing_) return;
    take_tasks(lock);
  }
}

void ThreadTeam::take_tasks(std::unique_lock<std::mutex>& lock) {
  while (next_ < count_) {
    const int task = next_++;
    const std::function<void(int)>& act = *act_;
    lock.unlock();
    act(task);
    lock.lock();
    if (--unfinished_ == 0) done_.notify_one();
  }
}

}  // namespace skinframe
