// SPDX-License-Identifier: Apache-2.0
// A client that sees all and believes nothing: submits jobs until each is acknowledged, watches every one of
// them to its end over whichever server answers, and judges what it saw.
#pragma once

#include <grpcpp/channel.h>

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "skinframe/v1/artifact.grpc.pb.h"
#include "skinframe/v1/job.grpc.pb.h"
#include "skinframe/v1/worker.grpc.pb.h"
#include "tests/faults/job_judge.h"

namespace skinframe::faults {

struct Verdict {
  std::vector<std::string> faults;  // "job ID: what"
  int jobs = 0;
  int attempts = 0;
  std::int64_t events = 0;
  std::int64_t reconnections = 0;  // of watches
};

class Witness {
 public:
  explicit Witness(const std::vector<std::string>& server_addresses);
  ~Witness();  // ends the watches
  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;

  // Both return once the server has acknowledged, however often it must be asked; from any thread.
  std::string upload(const std::string& content);  // its SHA-256
  std::string submit(const v1::JobSpec& spec);     // the job's id; a watch of it begins

  void watch_also(const std::string& job_id);  // one that was submitted past the witness

  int submitted() const;
  int running_or_queued() const;
  // Waits until the condition holds, asked after each event; false when it did not within the time.
  bool wait(std::chrono::seconds at_most, const std::function<bool()>& condition);
  bool wait_for_all(std::chrono::seconds at_most);
  v1::JobState state_of(const std::string& job_id) const;
  int attempt_of(const std::string& job_id) const;
  bool noted(const std::string& job_id, const std::string& words) const;  // in its progress

  // After the end of all jobs: asks for each job and each file again, reads in the logs of the workers which
  // results they hold for accepted, and compares each file PATH with expected[PATH] by `same`.
  using SameFile = std::function<bool(const std::string& path, const std::string& content)>;
  Verdict judge(const std::vector<std::filesystem::path>& worker_logs, const SameFile& same);

  v1::JobService::Stub& jobs(std::size_t server) { return *servers_.at(server).jobs; }
  v1::WorkerService::Stub& workers(std::size_t server) { return *servers_.at(server).workers; }

 private:
  struct Server {
    std::unique_ptr<v1::JobService::Stub> jobs;
    std::unique_ptr<v1::ArtifactService::Stub> artifacts;
    std::unique_ptr<v1::WorkerService::Stub> workers;
  };
  // Calls attempt(server) with one server after the other until it says OK or something that is no fault of
  // the connection.
  grpc::Status insist(const std::function<grpc::Status(Server&, grpc::ClientContext&)>& attempt);
  void watch(std::stop_token stop, const std::string& job_id);
  void rest();  // between two attempts
  std::string download(const std::string& sha256);

  std::vector<Server> servers_;
  std::stop_source end_;
  mutable std::mutex mutex_;
  std::condition_variable_any news_;
  std::map<std::string, JobJudge> judges_;    // by job id
  std::map<std::string, std::string> notes_;  // by job id, one after the other
  std::int64_t events_ = 0;
  std::int64_t reconnections_ = 0;
  int requests_made_ = 0;
  std::size_t acknowledged_ = 0;  // each with another request id, so each another job
  std::vector<std::jthread> watches_;
};

}  // namespace skinframe::faults
