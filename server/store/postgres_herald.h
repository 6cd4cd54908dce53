// SPDX-License-Identifier: Apache-2.0
// Tells the other servers on the database what has changed, after the commit and on a thread of its own.
// NOTIFY takes one lock for the whole database until its transaction is committed: within the transactions of
// the store, each of which waits for the disk, it would line all of them up, one sync after another. So it
// has transactions of its own, which do not wait for the disk and take together what has come meanwhile.
//
// What is lost with this process, or while the database is away, is no more than a wake-up: waiting workers
// and watched jobs are looked at by themselves some times a second.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/store/postgres_news.h"
#include "server/store/postgres_session.h"

namespace skinframe::server {

class PostgresHerald {
 public:
  static constexpr std::size_t kMostWaiting = 10'000;  // of more the oldest go

  explicit PostgresHerald(std::string where);
  ~PostgresHerald();  // tells what waits, if that goes at once
  PostgresHerald(const PostgresHerald&) = delete;
  PostgresHerald& operator=(const PostgresHerald&) = delete;

  void tell(const News& news);  // does not block

 private:
  void run();
  bool send(const std::vector<std::string>& payloads);

  const std::string where_;
  std::unique_ptr<PostgresSession> session_;  // only the thread
  bool reachable_ = true;                     // only the thread
  std::mutex mutex_;                          // guards what follows
  std::condition_variable changed_;
  std::deque<std::string> waiting_;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace skinframe::server
