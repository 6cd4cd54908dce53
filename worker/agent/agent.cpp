// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/agent.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <random>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "proto/metrics/metrics_listener.h"
#include "proto/metrics/process_metrics.h"
#include "proto/transport/backoff.h"
#include "proto/transport/channel.h"
#include "worker/agent/child_process.h"
#include "worker/agent/job_runner.h"
#include "worker/agent/pulse.h"
#include "worker/agent/wait.h"
#include "worker/agent/work_folder.h"
#include "worker/run/stop_signals.h"

namespace skinframe {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::chrono::seconds kLeaseWait{10};  // one long poll
constexpr std::chrono::seconds kLeaseGrace{5};  // for the answer to come after that
constexpr milliseconds kShortestPoll{50};       // an empty answer sooner than this is not a long poll

std::string random_hex() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", device(), device(), device(), device());
}

std::string default_name() {
  std::array<char, 64> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) return fmt::format("worker-{}", ::getpid());
  return fmt::format("{}-{}", host.data(), ::getpid());
}

Result<std::shared_ptr<grpc::Channel>> open_channel(const AgentOptions& options) {
  transport::ChannelOptions how;
  how.address = options.server_address;
  how.tls = {options.tls_root_cert, options.tls_cert, options.tls_key};
  how.ping_timeout = milliseconds(5'000);
  how.longest_reconnect = milliseconds(2'000);
  auto channel = transport::open_channel(how);
  if (!channel.ok()) return io_error(std::string(channel.status().message()));
  return *std::move(channel);
}

Result<std::filesystem::path> work_root(const AgentOptions& options) {
  if (!options.work_root.empty()) return std::filesystem::absolute(options.work_root);
  std::error_code error;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
  if (!error) return std::filesystem::absolute(temporary / "skinframe-worker");
  return io_error(
      fmt::format("no temporary folder: {}; set TMPDIR to a folder that can be written, or give "
                  "--work-dir",
                  error.message()));
}

// Null: nobody asked for them.
Result<std::unique_ptr<metrics::MetricsListener>> show_metrics(const AgentOptions& options) {
  std::unique_ptr<metrics::MetricsListener> listener;
  if (options.metrics_address.empty()) return listener;
  options.metrics->set_slots(options.slots);
  try {
    listener = std::make_unique<metrics::MetricsListener>(
        options.metrics_address,
        metrics::Sources{options.metrics->registry(), std::make_shared<metrics::ProcessMetrics>("worker")});
  } catch (const std::runtime_error& error) {
    return io_error(fmt::format("--metrics: {}", error.what()));
  }
  spdlog::info("metrics at http://{}/metrics", listener->address());
  return listener;
}

// One job at a time: ask, run, ask again.
class Slot {
 public:
  Slot(const AgentOptions& options, std::string worker_id, std::string instance_id,
       const std::filesystem::path& folder, const std::shared_ptr<grpc::Channel>& channel)
      : options_(options),
        folder_(folder),
        worker_(v1::WorkerService::NewStub(channel)),
        artifacts_(v1::ArtifactService::NewStub(channel)) {
    request_.set_worker_id(std::move(worker_id));
    request_.set_instance_id(std::move(instance_id));
    request_.set_version(SKINFRAME_VERSION);
    *request_.mutable_wait() = google::protobuf::util::TimeUtil::SecondsToDuration(kLeaseWait.count());
  }

  // Ends on drain as soon as it has no job, on stop at once.
  void run(const std::stop_token& stop, const std::stop_token& drain) {
    transport::Backoff backoff(milliseconds(100), milliseconds(5000));
    bool answered = true;
    std::stop_source no_more;
    const std::stop_callback on_stop(stop, [&] { no_more.request_stop(); });
    const std::stop_callback on_drain(drain, [&] { no_more.request_stop(); });
    while (!no_more.stop_requested()) {
      v1::LeaseResponse response;
      const auto asked = steady_clock::now();
      const grpc::Status status = lease(no_more.get_token(), !answered, response);
      if (status.ok() && response.has_assignment()) {
        backoff.reset();
        agent::run_assignment(options_, folder_, {*worker_, *artifacts_}, response.assignment(), stop);
      } else if (status.ok() && steady_clock::now() - asked >= kShortestPoll) {
        backoff.reset();
      } else if (!no_more.stop_requested()) {
        if (answered && !status.ok()) {
          spdlog::warn("{} gives no jobs: {}; asking again until it does", options_.server_address,
                       status.error_message());
        }
        agent::wait_unless_stopped(no_more.get_token(), backoff.next());
      }
      if (status.ok() && !answered) spdlog::info("{} answers again", options_.server_address);
      answered = status.ok();
    }
  }

 private:
  // A channel gets on with connecting only while a call waits for it: calls that fail at once would leave a
  // TLS handshake unfinished for ever.
  grpc::Status lease(const std::stop_token& stop, bool wait_for_server, v1::LeaseResponse& response) {
    grpc::ClientContext context;
    context.set_wait_for_ready(wait_for_server);
    context.set_deadline(std::chrono::system_clock::now() + kLeaseWait + kLeaseGrace);
    const std::stop_callback cancel(stop, [&] { context.TryCancel(); });
    return worker_->Lease(&context, request_, &response);
  }

  const AgentOptions& options_;
  const std::filesystem::path& folder_;
  std::unique_ptr<v1::WorkerService::Stub> worker_;
  std::unique_ptr<v1::ArtifactService::Stub> artifacts_;
  v1::LeaseRequest request_;
};

}  // namespace

Status AgentOptions::validate() const {
  if (server_address.empty()) return invalid_input("the server's address is empty");
  if (slots < 1 || slots > 64) return invalid_input(fmt::format("slots: {} is not in 1 .. 64", slots));
  if (threads_per_job < 1 || threads_per_job > 256) {
    return invalid_input(fmt::format("threads per job: {} is not in 1 .. 256", threads_per_job));
  }
  if (memory_limit_mb != 0 && memory_limit_mb < 64) {
    return invalid_input(fmt::format("memory limit: {} MB is neither 0 nor at least 64", memory_limit_mb));
  }
  if (tls_cert.empty() != tls_key.empty())
    return invalid_input("the worker's TLS certificate and its key must be given together");
  if (!tls_cert.empty() && tls_root_cert.empty())
    return invalid_input("the worker's TLS certificate needs that of the authority beside it (--tls-ca)");
  if (drain && *drain < milliseconds(0)) return invalid_input("the time to drain is negative");
  if (worker_name.size() > 96) return invalid_input("the worker's name is longer than 96 bytes");
  return ok_status();
}

Status run_agent_until(const AgentOptions& options, const std::shared_ptr<grpc::Channel>& channel,
                       std::stop_token stop, std::stop_token drain) {
  const std::string instance_id = random_hex();
  const auto root = work_root(options);
  if (!root) return root.error();
  const auto folder = agent::AgentFolder::create(*root, instance_id);
  if (!folder) return folder.error();
  const agent::Pulse pulse(folder->path(), channel);
  const std::string name = options.worker_name.empty() ? default_name() : options.worker_name;
  spdlog::info("{} asks {} for jobs, {} at a time, in {}", name, options.server_address, options.slots,
               folder->path().string());
  std::vector<std::thread> threads;
  for (int i = 0; i < options.slots; ++i) {
    threads.emplace_back([&, i] {
      Slot(options, fmt::format("{}-{}", name, i), instance_id, folder->path(), channel).run(stop, drain);
    });
  }
  for (std::thread& thread : threads) thread.join();
  return ok_status();
}

Status check_agent_health(const AgentOptions& options) {
  const auto root = work_root(options);
  if (!root) return root.error();
  return agent::check_pulse(*root, std::filesystem::file_time_type::clock::now());
}

int run_agent(const AgentOptions& options) {
  const StopSignals signals;
  Status status = options.validate();
  if (status) {
    const auto channel = open_channel(options);
    const auto listener = show_metrics(options);
    if (!listener) {
      status = listener.error();
    } else if (channel) {
      std::stop_source stop;
      std::stop_source drain;
      std::atomic<bool> done = false;
      std::thread waiting([&] {
        std::optional<steady_clock::time_point> hand_back;
        while (!done) {
          const bool came = signals.came_within(milliseconds(100));
          const bool first = came && drain.request_stop();
          if (first) {
            spdlog::info("draining: running jobs go on, no more are taken; a further signal hands them back");
            if (options.drain) hand_back = steady_clock::now() + *options.drain;
          }
          const bool over = (came && !first) || (hand_back && steady_clock::now() >= *hand_back);
          if (over && stop.request_stop()) spdlog::info("stopping");
        }
      });
      status = run_agent_until(options, *channel, stop.get_token(), drain.get_token());
      done = true;
      waiting.join();
    } else {
      status = channel.error();
    }
  }
  if (status) return 0;
  spdlog::error("{}", status.error().message);
  return 1;
}

}  // namespace skinframe
