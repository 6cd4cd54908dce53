// SPDX-License-Identifier: Apache-2.0
// What each verb does. Data on stdout, everything else on stderr; the result is the exit code.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "client/call/connect.h"
#include "client/cli/exit_code.h"
#include "client/cli/interrupts.h"
#include "client/cli/job_arguments.h"

namespace skinframe::client {

struct GlobalArguments {
  ConnectOptions server;
  bool json = false;
};

struct RunArguments {
  JobArguments job;
  std::filesystem::path out;
  std::filesystem::path data;      // empty: temporary
  std::filesystem::path profiles;  // folder of further printers and materials; empty: none
};

struct SubmitArguments {
  JobArguments job;
  bool watch = false;
  std::filesystem::path out;
};

struct ListArguments {
  std::vector<std::string> states, labels;
  int limit = 50;
};

// The server that the arguments name, by a connection whose calls end with an interrupt.
Result<Connection> open(const GlobalArguments& global, const Interrupts& interrupts);

// follow_verbs.cpp: they stay with their job.
ExitCode run(const GlobalArguments& global, const RunArguments& arguments);
ExitCode submit(const GlobalArguments& global, const SubmitArguments& arguments);
ExitCode watch(const GlobalArguments& global, const std::string& job_id, std::int64_t after_sequence);
// job_verbs.cpp: one question each.
ExitCode get(const GlobalArguments& global, const std::string& job_id);
ExitCode list(const GlobalArguments& global, const ListArguments& arguments);
ExitCode cancel(const GlobalArguments& global, const std::string& job_id);
ExitCode remove(const GlobalArguments& global, const std::string& job_id);
ExitCode download(const GlobalArguments& global, const std::string& job_id, const std::filesystem::path& out);
// catalog_verbs.cpp. id empty: all of them, in a list.
ExitCode printers(const GlobalArguments& global, const std::string& id);
ExitCode materials(const GlobalArguments& global, const std::string& id);

}  // namespace skinframe::client
