// SPDX-License-Identifier: GPL-3.0-or-later
// skinframe-worker: the agent that works for a server, and the verbs that run on this machine alone.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <optional>

#include "proto/command_line/surroundings.h"
#include "worker/agent/agent.h"
#include "worker/app/local_verbs.h"
#include "worker/app/profile_verbs.h"
#include "worker/job/run_job.h"
#include "worker/run/one_blas_thread.h"

int main(int argc, char** argv) {
  using namespace skinframe;
  use_one_blas_thread();
  // For the jobs' processes: none of OpenBLAS' own threads, which take a buffer each whenever they come to
  // it, and then the one that the job has reserved (reserve_blas.h).
  ::setenv("OPENBLAS_NUM_THREADS", "1", 1);
  // And none of CHOLMOD's, which are four however many the job was given, and spin while others work.
  ::setenv("OMP_THREAD_LIMIT", "1", 1);
  spdlog::set_default_logger(spdlog::stderr_color_mt("worker"));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %v");

  CLI::App app{"Runs skin-frame jobs for a server, each in a process of its own."};
  app.set_version_flag("--version", "skinframe-worker " SKINFRAME_VERSION);
  app.footer(
      "Examples:\n"
      "  skinframe-worker --server farm:7350 --slots 2      work for that server, two jobs at a time\n"
      "  skinframe-worker solve-frame P.json --out R.json   the optimiser alone\n"
      "  skinframe-worker check DIR                         judge exported files; 0: every claim holds, 1: "
      "one does not\n"
      "  skinframe-worker render DIR                        pictures of exported files\n"
      "  skinframe-worker sample --list                     the bodies that ship with the program");

  AgentOptions agent;
  std::string work_root, tls_ca, tls_cert, tls_key;
  std::optional<double> drain_seconds;
  app.add_option("--server", agent.server_address, "Server to work for, HOST:PORT")
      ->envname("SKINFRAME_SERVER")
      ->capture_default_str();
  app.add_option("--slots", agent.slots, "Jobs at a time")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--work-dir", work_root,
                 "Folder for the files of running jobs (default: a folder under TMPDIR)");
  app.add_option("--tls-ca", tls_ca, "PEM file of the certificate authority; turns TLS on");
  app.add_option("--tls-cert", tls_cert, "PEM certificate chain by which the server knows this worker");
  app.add_option("--tls-key", tls_key, "PEM private key of that certificate");
  app.add_option("--drain", drain_seconds,
                 "Seconds that running jobs may go on after the first SIGTERM before they are handed back; "
                 "0: none (default: to their end, or to a second SIGTERM)")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--memory-limit-mb", agent.memory_limit_mb,
                 "Address space of one job's process; 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--threads", agent.threads_per_job, "Threads of one job")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option(
      "--metrics", agent.metrics_address,
      "Serve Prometheus metrics at http://ADDRESS:PORT/metrics, in the clear; PORT alone is 127.0.0.1");
  app.add_option("--name", agent.worker_name, "Name shown to people (default: host and process)");

  bool check_health = false;
  app.add_flag("--check-health", check_health,
               "Say whether a worker with this --work-dir is connected to its server: 0 or 1; starts none");

  take_from_surroundings(app, "SKINFRAME_WORKER_");

  std::string job_dir;
  CLI::App* job = app.add_subcommand("run-job", "One job in this process; the agent calls it");
  job->add_option("WORKDIR", job_dir, "Folder with job.json")->required();
  LocalVerbs local(app);
  ProfileVerbs profiles(app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;  // 2: wrong usage, whatever CLI11 numbers it
  }

  if (job->parsed()) return run_job(job_dir);
  if (const auto code = local.run()) return *code;
  if (const auto code = profiles.run()) return *code;
  agent.work_root = work_root;
  agent.tls_root_cert = tls_ca;
  agent.tls_cert = tls_cert;
  agent.tls_key = tls_key;
  if (drain_seconds) agent.drain = std::chrono::milliseconds(std::llround(*drain_seconds * 1000));
  if (check_health) {
    const auto healthy = check_agent_health(agent);
    if (!healthy) std::cerr << "skinframe-worker: " << healthy.error().message << '\n';
    return healthy ? 0 : 1;
  }
  if (auto valid = agent.validate(); !valid) {
    std::cerr << "skinframe-worker: " << valid.error().message << '\n';
    return 2;
  }
  return run_agent(agent);
}
