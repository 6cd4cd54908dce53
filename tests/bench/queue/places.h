// SPDX-License-Identifier: Apache-2.0
// Where the figures are taken: a fresh store of either kind on the disk that is asked for, and what that disk
// takes for one sync, without which no durable figure says anything.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "server/store/job_store.h"
#include "tests/server/fixture/postgres_server.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::bench {

class Places {
 public:
  explicit Places(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // kind: "sqlite" or "postgres". An empty store, durable as in service. Throws when it cannot be had.
  std::unique_ptr<server::JobStore> fresh_store(const std::string& kind);
  // The same without a disk to wait for: what the store itself costs.
  std::unique_ptr<server::JobStore> fresh_store_in_memory(const std::string& kind);
  std::string fresh_postgres();  // postgresql://... of an empty database
  std::filesystem::path fresh_folder();

 private:
  std::filesystem::path folder_;
  int next_ = 0;
  server::TemporaryFolder memory_;
  std::unique_ptr<server::PostgresServer> postgres_;  // both started when they are asked for first
  std::unique_ptr<server::PostgresServer> fast_postgres_;
};

// The median of so many times 4 KiB written and synced, in milliseconds.
double sync_ms(const std::filesystem::path& folder, int times);

}  // namespace skinframe::bench
