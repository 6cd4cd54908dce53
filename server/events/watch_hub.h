// SPDX-License-Identifier: Apache-2.0
// Wakes whoever watches a job. A wake carries no event: the watcher reads the store from its own sequence
// number, at its own pace. So no event can be lost or doubled on the way, a slow watcher holds nobody up, and
// each costs a few bytes here.
//
// A watcher subscribes first and reads then: what is committed between the two wakes it once too often, never
// once too few.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"

namespace skinframe::server {

// Called on the committing thread: must be quick, and must not call the hub's subscribe or unsubscribe.
class Watcher {
 public:
  virtual ~Watcher() = default;
  virtual void wake() = 0;
  virtual void server_stops() = 0;
};

class WatchHub {
 public:
  explicit WatchHub(std::size_t most_watchers) : most_watchers_(most_watchers) {}

  // RESOURCE_EXHAUSTED: too many watchers. UNAVAILABLE: the server stops.
  absl::Status subscribe(const std::string& job_id, std::shared_ptr<Watcher> watcher);
  void unsubscribe(const std::string& job_id, const Watcher* watcher);  // no harm when not subscribed

  void wake(const std::string& job_id);
  void wake_all();
  void close();  // tells all that the server stops; nobody subscribes any more

  // Changes with each wake of a watched job, before its watchers are woken. kUnknown: nobody watches it.
  static constexpr std::uint64_t kUnknown = 0;
  std::uint64_t news(const std::string& job_id) const;

  std::size_t watchers() const;
  std::vector<std::string> watched_jobs() const;

 private:
  struct Watched {
    std::vector<std::shared_ptr<Watcher>> watchers;
    std::uint64_t news = kUnknown;
  };

  const std::size_t most_watchers_;
  mutable std::mutex mutex_;
  std::unordered_map<std::string, Watched> by_job_;
  std::size_t count_ = 0;
  std::uint64_t last_news_ = kUnknown;  // one count for all jobs: no number comes twice
  bool closed_ = false;
};

}  // namespace skinframe::server
