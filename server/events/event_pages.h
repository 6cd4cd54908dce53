// SPDX-License-Identifier: Apache-2.0
// Pages of events as streams read them. Two thousand watchers of one job stand at the same place: the first
// to ask reads the store, the others get what it read, for as long as the hub has had no news of the job
// since. A full page is right for ever: events are appended, never changed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/events/watch_hub.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::server {

struct EventPage {
  std::shared_ptr<const std::vector<v1::JobEvent>> events;
  bool to_the_end = false;  // there was nothing behind it when after() was called
};

class EventPages {
 public:
  // The store's events of a job after a sequence number, at most so many. Called on any thread.
  using Read = std::function<absl::StatusOr<std::vector<v1::JobEvent>>(
      const std::string& job_id, std::int64_t after_sequence, int limit)>;
  static constexpr int kPage = 64;  // events

  EventPages(const WatchHub& hub, Read read) : hub_(hub), read_(std::move(read)) {}

  // What read says. Only for jobs that the caller watches.
  absl::StatusOr<EventPage> after(const std::string& job_id, std::int64_t sequence);

 private:
  struct Known {
    std::string job_id;
    std::int64_t sequence = 0;
    std::uint64_t news = 0;  // the hub's count before the read
    std::shared_ptr<const std::vector<v1::JobEvent>> events;
  };
  static constexpr std::size_t kKnown = 64;  // bounds the memory; the oldest goes

  const WatchHub& hub_;
  const Read read_;
  std::mutex mutex_;
  std::array<Known, kKnown> known_;
  std::size_t next_ = 0;  // to be overwritten
};

}  // namespace skinframe::server
