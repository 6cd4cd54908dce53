// SPDX-License-Identifier: Apache-2.0
#include "client/cli/embedded_farm.h"

#include <fmt/format.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "client/cli/background_process.h"
#include "client/cli/sibling.h"

namespace skinframe::client {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr std::chrono::seconds kStartTime{20};
constexpr std::chrono::milliseconds kStopTime{5000};
constexpr int kWorkerRestarts = 3;
constexpr int kPortFilePollMs = 10;

// "127.0.0.1:7350", or a port alone.
std::optional<std::string> read_address(const fs::path& port_file) {
  std::ifstream in(port_file);
  std::string text;
  if (!(in >> text) || text.empty()) return std::nullopt;
  return text.find(':') == std::string::npos ? "127.0.0.1:" + text : text;
}

std::string last_line(const fs::path& log) {
  std::ifstream in(log);
  std::string line, last;
  while (std::getline(in, line)) {
    if (!line.empty()) last = line;
  }
  return last.empty() ? std::string("it said nothing") : last.substr(0, 400);
}

bool wait_readable(int fd, int quit, int timeout_ms) {
  std::array<pollfd, 2> fds{{{fd, POLLIN, 0}, {quit, POLLIN, 0}}};
  return ::poll(fds.data(), fds.size(), timeout_ms) > 0;
}

}  // namespace

EmbeddedFarm::EmbeddedFarm(fs::path data, fs::path profiles, std::stop_source stop)
    : data_(std::move(data)),
      profiles_(std::move(profiles)),
      stop_(std::move(stop)),
      quit_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  std::promise<Result<std::string>> started;
  started_ = started.get_future();
  // One thread starts, watches and stops both: the system ends a child when the thread that started it ends.
  thread_ = std::thread([this, promise = std::move(started)]() mutable { run(std::move(promise)); });
}

EmbeddedFarm::~EmbeddedFarm() {
  ::eventfd_write(quit_, 1);
  thread_.join();
  ::close(quit_);
  std::error_code ignored;
  if (folder_.empty()) return;
  if (keep_logs_) {
    for (const char* part : {"data", "work", "port"}) fs::remove_all(folder_ / part, ignored);
  } else {
    fs::remove_all(folder_, ignored);
  }
}

Result<std::string> EmbeddedFarm::address() { return started_.get(); }

std::optional<Failure> EmbeddedFarm::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

fs::path EmbeddedFarm::keep_logs() {
  keep_logs_ = true;
  return folder_;
}

void EmbeddedFarm::fail(Failure failure) {
  {
    const std::lock_guard lock(mutex_);
    failure_ = std::move(failure);
  }
  stop_.request_stop();
}

void EmbeddedFarm::run(std::promise<Result<std::string>> started) {
  const auto ended = serve(started);
  if (!ended) {
    // Before the server listened the caller still waits for its address; after that it is told by failure().
    try {
      started.set_value(ended.failure());
    } catch (const std::future_error&) {
      fail(ended.failure());
    }
  }
}

Result<std::string> EmbeddedFarm::serve(std::promise<Result<std::string>>& started) {
  const auto server_path = server_program();
  if (!server_path) return server_path.failure();
  const auto worker_path = worker_program();
  if (!worker_path) return worker_path.failure();
  std::error_code error;
  std::string pattern = (fs::temp_directory_path(error) / "skinframe-run-XXXXXX").string();
  if (error || ::mkdtemp(pattern.data()) == nullptr) {
    return Failure{FailureKind::kLocal,
                   fmt::format("no temporary folder like {}: {}; set TMPDIR to a folder that can "
                               "be written",
                               pattern, std::strerror(errno))};
  }
  folder_ = pattern;
  const fs::path data = data_.empty() ? folder_ / "data" : data_;
  const fs::path server_log = folder_ / "server.log", worker_log = folder_ / "worker.log";

  std::vector<std::string> server_words = {server_path->string(), "--listen",    "127.0.0.1:0",   "--data",
                                           data.string(),         "--port-file", folder_ / "port"};
  if (!profiles_.empty()) server_words.insert(server_words.end(), {"--profiles", profiles_.string()});
  auto server = BackgroundProcess::start(server_words, server_log);
  if (!server) return server.failure();
  std::optional<std::string> address;
  for (const auto give_up = steady_clock::now() + kStartTime; !(address = read_address(folder_ / "port"));) {
    if (stop_.stop_requested()) return Failure{FailureKind::kInterrupted, "interrupted"};
    if (wait_readable(server->exit_fd(), quit_, kPortFilePollMs) || steady_clock::now() > give_up) {
      return Failure{FailureKind::kLocal, "the embedded server did not start: " + last_line(server_log)};
    }
  }
  const std::string threads = std::to_string(std::clamp(std::thread::hardware_concurrency(), 1U, 256U));
  const std::vector<std::string> worker_words = {
      worker_path->string(), "--server",       *address,  "--slots", "1", "--threads", threads,
      "--work-dir",          folder_ / "work", "--drain", "0"};
  auto worker = BackgroundProcess::start(worker_words, worker_log);
  if (!worker) return worker.failure();
  started.set_value(*address);

  for (int restarts = 0;;) {
    std::array<pollfd, 3> fds{
        {{quit_, POLLIN, 0}, {server->exit_fd(), POLLIN, 0}, {worker->exit_fd(), POLLIN, 0}}};
    if (::poll(fds.data(), fds.size(), -1) < 0 && errno != EINTR) break;
    if (fds[0].revents != 0) break;
    if (fds[1].revents != 0) {
      return Failure{FailureKind::kLocal, "the embedded server ended: " + last_line(server_log)};
    }
    if (fds[2].revents != 0) {
      if (++restarts > kWorkerRestarts) {
        return Failure{FailureKind::kLocal, "the embedded worker keeps ending: " + last_line(worker_log)};
      }
      worker->stop(std::chrono::milliseconds(0));
      auto next = BackgroundProcess::start(worker_words, worker_log);
      if (!next) return next.failure();
      *worker = *std::move(next);
    }
  }
  worker->stop(kStopTime);  // first: it hands its job back to a server that is there
  server->stop(kStopTime);
  return *address;
}

}  // namespace skinframe::client
