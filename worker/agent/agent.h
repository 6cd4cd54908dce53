// SPDX-License-Identifier: GPL-3.0-or-later
// The worker's agent: it asks the server for jobs, runs each in a process of its own, tells of the progress
// and brings the results back. The only room of the worker that sees gRPC; it knows nothing of meshes.
//
// Guarantees
//   - A job's crash, endless loop or hunger for memory ends its own process, never the agent.
//   - A job whose lease is lost is stopped and its result dropped (WorkerService answers ABORTED).
//   - Cancellation, the job's deadline and the agent's own hard end stop the job within 2 s (SIGTERM,
//   SIGKILL 1.5 s later).
//   - Work folders go when the job is done; those of an agent that was killed go when the next one starts.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "worker/metrics/worker_metrics.h"
#include "worker/run/result.h"

namespace grpc {
class Channel;
}

namespace skinframe {

struct AgentOptions {
  std::string server_address = "127.0.0.1:7350";
  int slots = 1;                        // jobs at a time, 1 .. 64
  std::filesystem::path work_root;      // empty: "skinframe-worker" in the folder for temporary files
  std::filesystem::path tls_root_cert;  // PEM file; empty: no TLS
  std::filesystem::path tls_cert;       // PEM chain by which the server knows this worker; both or none
  std::filesystem::path tls_key;
  // How long running jobs may go on after the first stop signal before they are handed back; none: to their
  // end.
  std::optional<std::chrono::milliseconds> drain;
  int memory_limit_mb = 0;  // address space of one job's process, at least 64; 0: no limit
  int threads_per_job = 1;  // 1 .. 256
  std::string worker_name;  // for people, at most 96 bytes; empty: host name and process id
  std::filesystem::path self_executable = "/proc/self/exe";  // run as: self_executable run-job WORKDIR
  std::string
      metrics_address;  // PORT or IP:PORT of the Prometheus metrics (proto/metrics); empty: not served
  std::shared_ptr<WorkerMetrics> metrics = std::make_shared<WorkerMetrics>();  // what is counted meanwhile

  Status validate() const;
};

// Works until SIGTERM or SIGINT, whichever thread they reach; afterwards both are ignored. On the first
// signal the worker drains: it takes no more jobs, and ends with the last one that runs. On a second one, or
// when the time for that is over, the running jobs are stopped and handed back: another worker takes them
// over at once, and no attempt is lost. Returns the process's exit code: 0 after a clean stop, 1 when it
// could not start (the reason is logged).
int run_agent(const AgentOptions& options);

// The same without signals, over a channel that is there: works until stop, or until the last job's end after
// drain. Options are valid.
Status run_agent_until(const AgentOptions& options, const std::shared_ptr<grpc::Channel>& channel,
                       std::stop_token stop, std::stop_token drain = {});

// For health checks: ok when an agent of this work folder is connected to its server. It says nothing of
// jobs, and a worker whose server is away is not ill: its jobs go on, so nothing should be restarted because
// of it.
Status check_agent_health(const AgentOptions& options);

}  // namespace skinframe
