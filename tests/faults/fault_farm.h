// SPDX-License-Identifier: Apache-2.0
// Servers, workers and, with PostgreSQL, the database of a test: real processes, each of which can be killed,
// frozen and started again. All calls from the test's own thread: what it started dies with it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/integration/process.h"
#include "tests/server/fixture/postgres_server.h"

namespace skinframe::faults {

enum class Store { kSqlite, kPostgres };

struct FarmShape {
  Store store = Store::kSqlite;
  int servers = 1;  // more than one needs PostgreSQL
  int workers = 4;
};

struct Kills {
  int workers = 0, jobs = 0, servers = 0, databases = 0, freezes = 0;
  int total() const { return workers + jobs + servers + databases; }
};

class FaultFarm {
 public:
  // Leases of 1 s, so that takeovers are seen. data: where what the store keeps
  // is made, the servers' folders or the database's tables; empty: in scratch, or with the database's own.
  FaultFarm(const std::filesystem::path& scratch, const FarmShape& shape,
            const std::filesystem::path& data = {});

  const std::vector<std::string>& addresses() const { return addresses_; }
  int servers() const { return static_cast<int>(servers_.size()); }
  int workers() const { return static_cast<int>(workers_.size()); }

  // A worker's server is servers()[index % servers()], or what is given here before it starts again.
  void send_worker_to(int index, const std::string& address);

  void start_server(int index);
  void start_worker(int index);
  void add_worker();  // one more, of the first server
  // SIGKILL, waited for, counted. False: there was nothing to kill.
  bool kill_server(int index);
  bool kill_worker(int index);
  bool kill_job_of(int index);    // the process in which the worker runs its job
  bool kill_database();           // and starts it again
  bool freeze_worker(int index);  // SIGSTOP: of the agent alone, its job's process goes on
  void thaw_worker(int index);

  const Kills& kills() const { return kills_; }
  std::vector<std::filesystem::path> worker_logs() const;  // of all starts
  // Whether a worker told of this in any of its logs.
  bool workers_said(const std::string& words) const;
  integration::Process* server(int index) { return servers_.at(static_cast<std::size_t>(index)).get(); }

 private:
  std::filesystem::path scratch_, data_;
  std::unique_ptr<server::PostgresServer> database_;
  std::vector<std::string> store_flags_;
  std::vector<std::string> addresses_;
  std::vector<std::string> worker_addresses_;
  std::vector<std::unique_ptr<integration::Process>> servers_, workers_;
  std::vector<std::filesystem::path> worker_logs_;
  int starts_ = 0;
  Kills kills_;
};

}  // namespace skinframe::faults
