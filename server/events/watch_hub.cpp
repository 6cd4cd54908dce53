// SPDX-License-Identifier: Apache-2.0
#include "server/events/watch_hub.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace skinframe::server {

absl::Status WatchHub::subscribe(const std::string& job_id, std::shared_ptr<Watcher> watcher) {
  const std::lock_guard lock(mutex_);
  if (closed_) return absl::UnavailableError("the server stops");
  if (count_ >= most_watchers_) {
    return absl::ResourceExhaustedError(fmt::format("{} watchers are connected, which is the limit", count_));
  }
  Watched& job = by_job_[job_id];
  if (job.watchers.empty()) job.news = ++last_news_;
  job.watchers.push_back(std::move(watcher));
  ++count_;
  return absl::OkStatus();
}

void WatchHub::unsubscribe(const std::string& job_id, const Watcher* watcher) {
  const std::lock_guard lock(mutex_);
  const auto job = by_job_.find(job_id);
  if (job == by_job_.end()) return;
  auto& watchers = job->second.watchers;
  const auto at =
      std::find_if(watchers.begin(), watchers.end(), [&](const auto& w) { return w.get() == watcher; });
  if (at == watchers.end()) return;
  watchers.erase(at);
  --count_;
  if (watchers.empty()) by_job_.erase(job);
}

void WatchHub::wake(const std::string& job_id) {
  std::vector<std::shared_ptr<Watcher>> watchers;  // woken outside the lock
  {
    const std::lock_guard lock(mutex_);
    const auto job = by_job_.find(job_id);
    if (job == by_job_.end()) return;
    job->second.news = ++last_news_;
    watchers = job->second.watchers;
  }
  for (const auto& watcher : watchers) watcher->wake();
}

void WatchHub::wake_all() {
  for (const std::string& job_id : watched_jobs()) wake(job_id);
}

void WatchHub::close() {
  std::unordered_map<std::string, Watched> all;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    all = by_job_;
  }
  for (const auto& [job_id, job] : all) {
    for (const auto& watcher : job.watchers) watcher->server_stops();
  }
}

std::uint64_t WatchHub::news(const std::string& job_id) const {
  const std::lock_guard lock(mutex_);
  const auto job = by_job_.find(job_id);
  return job == by_job_.end() ? kUnknown : job->second.news;
}

std::vector<std::string> WatchHub::watched_jobs() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> jobs;
  jobs.reserve(by_job_.size());
  for (const auto& [job_id, job] : by_job_) jobs.push_back(job_id);
  return jobs;
}

std::size_t WatchHub::watchers() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

}  // namespace skinframe::server
