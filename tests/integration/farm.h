// SPDX-License-Identifier: Apache-2.0
// A server and workers of a test: real processes on a loopback port that the system picks.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/integration/process.h"

namespace skinframe::integration {

class Farm {
 public:
  // Short leases, so that a takeover is seen in seconds. server_words: further options of the server.
  explicit Farm(const Scratch& scratch, std::vector<std::string> server_words = {});

  // The server keeps its port over restarts, as an operator's would.
  void start_server();
  void kill_server();
  void stop_server();  // SIGTERM; expects a clean end
  Process& server() { return *server_; }
  Process& start_worker(const std::string& name);

  const std::string& address() const { return address_; }
  // `skinframe --server ADDRESS words...`
  std::vector<std::string> client(std::vector<std::string> words) const;
  Ran ask(std::vector<std::string> words) const { return run(client(std::move(words)), scratch_); }
  // Submits and returns the job's id; a test failure and "" when that fails.
  std::string submit(std::vector<std::string> words) const;
  std::string state_of(const std::string& job) const;
  // Whether the worker's job process is at work: a stage later than `read` has been told.
  bool at_work(const std::string& job) const;

 private:
  std::filesystem::path scratch_;
  std::vector<std::string> server_words_;
  std::string address_;
  std::unique_ptr<Process> server_;
  std::vector<std::unique_ptr<Process>> workers_;
  int starts_ = 0;
};

}  // namespace skinframe::integration
