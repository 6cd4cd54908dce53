// SPDX-License-Identifier: Apache-2.0
// Hears what other servers did on the same database (LISTEN) and tells the listener. After a break of the
// connection it reconnects, and says that news may have been missed.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "server/store/job_store.h"

namespace skinframe::server {

// What a NOTIFY of ours carries: who sent it, what the job became, which job.
struct News {
  enum class Kind { kQueued, kOtherState, kRemoved };
  std::string sender;
  Kind kind = Kind::kOtherState;
  std::string job_id;
};
std::string encode(const News& news);
bool decode(const std::string& payload, News& news);  // false: not ours

inline constexpr char kNewsChannel[] = "skinframe_jobs";

class PostgresNews {
 public:
  // own: news from this sender are passed over.
  PostgresNews(std::string where, std::string own, CommitListener& listener);
  ~PostgresNews();  // within half a second
  PostgresNews(const PostgresNews&) = delete;
  PostgresNews& operator=(const PostgresNews&) = delete;

 private:
  void run();
  void listen();  // until stopped; throws when the connection is lost

  const std::string where_;
  const std::string own_;
  CommitListener& listener_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace skinframe::server
