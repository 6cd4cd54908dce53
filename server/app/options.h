// SPDX-License-Identifier: Apache-2.0
// The command line of skinframe-server.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

#include "absl/status/status.h"
#include "server/jobs/attempt_policy.h"

namespace skinframe::server {

struct ServerOptions {
  std::string listen = "127.0.0.1:7350";
  std::filesystem::path data;      // holds the store and the artifacts
  std::filesystem::path tls_cert;  // PEM chain; both or none
  std::filesystem::path tls_key;
  bool allow_plaintext = false;
  std::string store = "sqlite";     // or postgresql://...
  std::filesystem::path artifacts;  // empty: in data
  AttemptPolicy policy;
  std::int64_t queue_limit = 10'000;  // 1 .. 1,000,000 queued jobs
  int keep_jobs_days = 30;            // after their end; 0: for ever; at most 3650
  std::filesystem::path profiles;     // folder of printers and materials; empty: the built-in ones alone
  int keep_progress_hours = 24;       // of an ended job; 0: for as long as the job; at most 87600
  std::filesystem::path tenants;      // file of tenants; empty: everybody is the default tenant
  std::filesystem::path
      client_ca;              // PEM; callers' certificates are verified against it; empty: not asked for
  Milliseconds drain{5'000};  // at the stop, for calls under way; 0 .. 1 h
  std::filesystem::path port_file;  // empty: none
  std::string metrics;              // address:port of the metrics; empty: none
  std::string check_health;         // address; not empty: ask the server there how it is, and start none

  bool store_is_postgres() const;

  // One sentence for what does not go together, is out of range, or is not built.
  absl::Status validate() const;
};

// The command line was --help, --version or wrong: what to print, and the exit code.
struct EarlyEnd {
  std::string text;
  int exit_code;  // 0, or 2 for wrong usage
};

std::variant<ServerOptions, EarlyEnd> parse_command_line(int argc, const char* const* argv);

}  // namespace skinframe::server
