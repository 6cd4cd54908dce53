// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/fault_farm.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <sstream>

namespace skinframe::faults {

using integration::binary;
using integration::eventually;
using integration::Process;
using integration::read_file;
using integration::Seconds;

namespace {

bool kill_and_wait(Process* process) {
  if (process == nullptr || !process->running()) return false;
  process->signal(SIGKILL);
  return process->wait(Seconds(30)) == 128 + SIGKILL;
}

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

FaultFarm::FaultFarm(const std::filesystem::path& scratch, const FarmShape& shape,
                     const std::filesystem::path& data)
    : scratch_(scratch), data_(data.empty() || shape.store == Store::kPostgres ? scratch : data) {
  if (shape.store == Store::kPostgres) {
    database_ = std::make_unique<server::PostgresServer>();
    store_flags_ = {"--store", database_->new_database(data), "--artifacts", scratch_ / "artifacts"};
  }
  addresses_.resize(at(shape.servers));
  servers_.resize(at(shape.servers));
  workers_.resize(at(shape.workers));
  for (int i = 0; i < shape.servers; ++i) start_server(i);
  for (int i = 0; i < shape.workers; ++i) worker_addresses_.push_back(addresses_[at(i % shape.servers)]);
  for (int i = 0; i < shape.workers; ++i) start_worker(i);
}

void FaultFarm::send_worker_to(int index, const std::string& address) {
  worker_addresses_[at(index)] = address;
}

void FaultFarm::start_server(int index) {
  std::string& address = addresses_[at(index)];
  // A database that was killed a moment ago may still refuse: an operator's service manager would try again.
  const bool up = eventually(
      [&] {
        const auto port_file = scratch_ / ("port-" + std::to_string(starts_));
        std::vector<std::string> command = {binary("skinframe-server"),
                                            "--listen",
                                            address.empty() ? "127.0.0.1:0" : address,
                                            "--data",
                                            data_ / ("server-" + std::to_string(index)),
                                            "--port-file",
                                            port_file,
                                            "--lease-seconds",
                                            "1",
                                            "--heartbeat-seconds",
                                            "0.25",
                                            "--max-attempts",
                                            "100"};
        command.insert(command.end(), store_flags_.begin(), store_flags_.end());
        auto& server = servers_[at(index)];
        server = std::make_unique<Process>(command, scratch_ / ("server-log-" + std::to_string(starts_++)));
        eventually([&] { return !read_file(port_file).empty() || !server->running(); }, Seconds(20));
        std::istringstream(read_file(port_file)) >> address;
        return server->running() && !read_file(port_file).empty();
      },
      Seconds(30));
  ASSERT_TRUE(up) << servers_[at(index)]->err();
}

void FaultFarm::start_worker(int index) {
  const std::string name = "worker-" + std::to_string(index);
  const auto log = scratch_ / ("worker-log-" + std::to_string(starts_++));
  workers_[at(index)] = std::make_unique<Process>(
      std::vector<std::string>{binary("skinframe-worker"), "--server", worker_addresses_[at(index)], "--name",
                               name, "--work-dir", scratch_ / ("work-" + std::to_string(index))},
      log);
  worker_logs_.push_back(log.string() + ".err");
}

void FaultFarm::add_worker() {
  worker_addresses_.push_back(addresses_[0]);
  workers_.emplace_back();
  start_worker(workers() - 1);
}

bool FaultFarm::kill_server(int index) {
  const bool killed = kill_and_wait(servers_[at(index)].get());
  kills_.servers += killed ? 1 : 0;
  return killed;
}

bool FaultFarm::kill_worker(int index) {
  const bool killed = kill_and_wait(workers_[at(index)].get());
  kills_.workers += killed ? 1 : 0;
  return killed;
}

bool FaultFarm::kill_job_of(int index) {
  if (!workers_[at(index)]->running()) return false;
  // Children of each of its threads.
  std::error_code gone;
  const auto tasks = std::filesystem::path("/proc") / std::to_string(workers_[at(index)]->pid()) / "task";
  for (const auto& task : std::filesystem::directory_iterator(tasks, gone)) {
    std::istringstream children(read_file(task.path() / "children"));
    pid_t child = 0;
    if (children >> child && child > 1 && ::kill(child, SIGKILL) == 0) {
      ++kills_.jobs;
      return true;
    }
  }
  return false;
}

bool FaultFarm::kill_database() {
  if (database_ == nullptr) return false;
  database_->restart();
  ++kills_.databases;
  return true;
}

bool FaultFarm::freeze_worker(int index) {
  if (!workers_[at(index)]->running()) return false;
  workers_[at(index)]->signal(SIGSTOP);
  ++kills_.freezes;
  return true;
}

void FaultFarm::thaw_worker(int index) { workers_[at(index)]->signal(SIGCONT); }

std::vector<std::filesystem::path> FaultFarm::worker_logs() const { return worker_logs_; }

bool FaultFarm::workers_said(const std::string& words) const {
  return std::any_of(worker_logs_.begin(), worker_logs_.end(),
                     [&](const auto& log) { return read_file(log).find(words) != std::string::npos; });
}

}  // namespace skinframe::faults
