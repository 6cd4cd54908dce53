// SPDX-License-Identifier: Apache-2.0
// Connections for reading, lent one at a time: as many as there are threads that read at once.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "server/store/sqlite_database.h"

namespace skinframe::server {

class SqliteReaders {
 public:
  explicit SqliteReaders(std::filesystem::path file) : file_(std::move(file)) {}

  // Runs read on a connection. It sees every commit that was acknowledged before.
  template <class Read>
  auto with(Read read) -> decltype(read(std::declval<SqliteDatabase&>())) {
    std::unique_ptr<SqliteDatabase> database;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        database = std::move(idle_.back());
        idle_.pop_back();
      }
    }
    if (database == nullptr) {
      auto opened = SqliteDatabase::open(file_, SqliteDatabase::Mode::kReadOnly);
      if (!opened.ok()) return opened.status();
      database = *std::move(opened);
    }
    auto result = read(*database);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(database));
    return result;
  }

 private:
  const std::filesystem::path file_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<SqliteDatabase>> idle_;
};

}  // namespace skinframe::server
