// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/pulse.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

#include "worker/agent/child_process.h"
#include "worker/agent/wait.h"

namespace skinframe::agent {
namespace {

namespace fs = std::filesystem;

constexpr char kFile[] = "connected";
constexpr std::chrono::milliseconds kLook{250};  // until the first connection is there

bool touch(const fs::path& file) {
  const Descriptor descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  return descriptor.get() >= 0 && ::futimens(descriptor.get(), nullptr) == 0;
}

void run(const std::stop_token& stop, const fs::path& file, grpc::Channel& channel) {
  bool written = true;
  bool wait = true;
  while (wait) {
    const bool connected = channel.GetState(false) == GRPC_CHANNEL_READY;
    if (connected && !touch(file) && std::exchange(written, false))
      spdlog::warn("{}: cannot be written: {}", file.string(), std::strerror(errno));
    wait = wait_unless_stopped(stop, connected ? std::chrono::milliseconds(kPulsePeriod) : kLook);
  }
}

}  // namespace

Pulse::Pulse(fs::path agent_folder, std::shared_ptr<grpc::Channel> channel)
    : thread_([file = std::move(agent_folder) / kFile,
               channel = std::move(channel)](const std::stop_token& stop) { run(stop, file, *channel); }) {}

Status check_pulse(const fs::path& root, fs::file_time_type now) {
  std::optional<fs::file_time_type> newest;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root, error)) {
    std::error_code absent;  // of an agent that has not been connected yet
    const auto time = fs::last_write_time(entry.path() / kFile, absent);
    if (!absent && (!newest || time > *newest)) newest = time;
  }
  if (!newest) return io_error(fmt::format("no worker in {} has reached its server yet", root.string()));
  const auto age = std::chrono::duration_cast<std::chrono::seconds>(now - *newest);
  if (age <= kPulseStale) return ok_status();
  return io_error(fmt::format("no worker in {} is connected to its server: the last was {} s ago",
                              root.string(), age.count()));
}

}  // namespace skinframe::agent
