// SPDX-License-Identifier: GPL-3.0-or-later
// A file that tells other processes that an agent is connected to its server: AGENTFOLDER/connected, touched
// while the channel is ready. A worker listens on no port, so this is what a container's health check can
// see.
#pragma once

#include <grpcpp/channel.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "worker/run/result.h"

namespace skinframe::agent {

inline constexpr std::chrono::seconds kPulsePeriod{5};
// The connection is gone for so long: some pulses, and the time in which keepalive notices a cut.
inline constexpr std::chrono::seconds kPulseStale{45};

class Pulse {
 public:
  // While it lives, a thread touches the file.
  Pulse(std::filesystem::path agent_folder, std::shared_ptr<grpc::Channel> channel);

 private:
  std::jthread thread_;
};

// ok when some agent's pulse below the root is younger than kPulseStale; otherwise says how old the newest
// is.
Status check_pulse(const std::filesystem::path& root, std::filesystem::file_time_type now);

}  // namespace skinframe::agent
