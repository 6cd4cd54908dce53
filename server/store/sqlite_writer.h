// SPDX-License-Identifier: Apache-2.0
// The one thread that writes. What waits when it becomes free goes into one transaction (group commit), each
// part behind a savepoint of its own, so that one part's failure does not touch the others; all callers wait
// for the commit. So the disk is waited for once a group, and never before a caller is told that its write is
// durable.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "absl/status/status.h"
#include "server/store/sqlite_database.h"

namespace skinframe::server {

class SqliteWriter {
 public:
  // One part of a transaction. A part that is not OK is rolled back alone.
  using Work = std::function<absl::Status(SqliteDatabase&)>;
  using Committed = std::function<void()>;

  SqliteWriter(std::unique_ptr<SqliteDatabase> database, std::size_t largest_group);
  ~SqliteWriter();  // finishes what waits
  SqliteWriter(const SqliteWriter&) = delete;
  SqliteWriter& operator=(const SqliteWriter&) = delete;

  // Blocks until the work is durable, or failed. committed runs on the writing thread after the commit, in
  // the order of the commits, and before this returns.
  absl::Status write(const Work& work, const Committed& committed);

  std::int64_t groups() const;  // transactions so far

 private:
  struct Part {
    const Work* work;
    const Committed* committed;
    absl::Status status;
    bool done = false;
  };

  void run();
  void commit_group(std::vector<Part*>& group);

  std::unique_ptr<SqliteDatabase> database_;
  const std::size_t largest_group_;
  mutable std::mutex mutex_;
  std::condition_variable work_there_;
  std::condition_variable work_done_;
  std::vector<Part*> waiting_;
  std::int64_t groups_ = 0;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace skinframe::server
