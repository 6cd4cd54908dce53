// SPDX-License-Identifier: Apache-2.0
#include "server/app/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <sstream>

#include "proto/command_line/surroundings.h"
#include "server/app/listen_address.h"

namespace skinframe::server {
namespace {

constexpr char kExamples[] =
    "\nExamples:\n"
    "  skinframe-server --data /var/lib/skinframe\n"
    "      for this machine alone, on 127.0.0.1:7350\n"
    "  skinframe-server --data DIR --listen 0.0.0.0:7350 --tls-cert server.crt --tls-key server.key\n"
    "      for the network, encrypted\n"
    "  skinframe-server --data DIR --store postgresql://skinframe@db/skinframe --artifacts "
    "/mnt/farm/artifacts\n"
    "      one of several servers on one database; PGPASSWORD or ~/.pgpass hold its password\n"
    "  skinframe-server --data DIR --profiles /etc/skinframe/profiles\n"
    "      with printers and materials of your own (server/catalog/README.md gives the format)\n"
    "  skinframe-server --data DIR --listen 127.0.0.1:0 --port-file DIR/port\n"
    "      on a free port, written to the file once it listens\n"
    "\nExit codes: 0 stopped by SIGTERM or SIGINT; 1 cannot run (port taken, folder in use or not writable, "
    "bad profile); "
    "2 wrong "
    "usage.\n";

Milliseconds from_seconds(double seconds) {
  return Milliseconds(static_cast<std::int64_t>(std::llround(seconds * 1000)));
}

std::string text_of(const CLI::App& app, const CLI::Error& error, int& code) {
  std::ostringstream out;
  std::ostringstream err;
  code = app.exit(error, out, err);
  return out.str() + err.str();
}

}  // namespace

bool ServerOptions::store_is_postgres() const {
  return store.starts_with("postgresql://") || store.starts_with("postgres://");
}

absl::Status ServerOptions::validate() const {
  if (data.empty())
    return absl::InvalidArgumentError("--data DIR is missing: the folder for jobs and artifacts");
  if (store != "sqlite" && !store_is_postgres()) {
    return absl::InvalidArgumentError(
        fmt::format("--store \"{}\" is unknown; known: sqlite, postgresql://USER@HOST/DATABASE", store));
  }
  if (store_is_postgres() && artifacts.empty()) {
    return absl::InvalidArgumentError(
        "--store postgresql needs --artifacts DIR: a folder that all servers on this database share (one "
        "server alone may give one of its own)");
  }
  if (tls_cert.empty() != tls_key.empty()) {
    return absl::InvalidArgumentError("--tls-cert and --tls-key must be given together");
  }
  if (queue_limit < 1 || queue_limit > 1'000'000) {
    return absl::InvalidArgumentError(
        fmt::format("--queue-limit is {}, must be within 1 .. 1000000", queue_limit));
  }
  if (keep_jobs_days < 0 || keep_jobs_days > 3650) {
    return absl::InvalidArgumentError(
        fmt::format("--keep-jobs-days is {}, must be within 0 .. 3650", keep_jobs_days));
  }
  if (keep_progress_hours < 0 || keep_progress_hours > 87'600) {
    return absl::InvalidArgumentError(
        fmt::format("--keep-progress-hours is {}, must be within 0 .. 87600", keep_progress_hours));
  }
  if (drain < Milliseconds(0) || drain > std::chrono::hours(1))
    return absl::InvalidArgumentError("--drain must be within 0 .. 3600 seconds");
  if (!client_ca.empty() && tls_cert.empty())
    return absl::InvalidArgumentError("--client-ca needs --tls-cert and --tls-key");
  if (!client_ca.empty() && tenants.empty()) {
    return absl::InvalidArgumentError(
        "--client-ca needs --tenants FILE, which says which callers are workers");
  }
  if (auto status = policy.validate(); !status.ok())
    return absl::InvalidArgumentError("--" + std::string(status.message()));
  if (auto status = check_listen_address(listen); !status.ok()) return status;
  if (tls_cert.empty() && !allow_plaintext && !is_loopback(listen)) {
    return absl::InvalidArgumentError(fmt::format(
        "--listen {} is reachable from the network: give --tls-cert and --tls-key, or --allow-plaintext",
        listen));
  }
  return absl::OkStatus();
}

std::variant<ServerOptions, EarlyEnd> parse_command_line(int argc, const char* const* argv) {
  ServerOptions options;
  double lease_seconds = static_cast<double>(options.policy.lease.count()) / 1000;
  double heartbeat_seconds = static_cast<double>(options.policy.heartbeat.count()) / 1000;
  double drain_seconds = static_cast<double>(options.drain.count()) / 1000;
  double ageing_seconds = static_cast<double>(options.policy.ageing.count()) / 1000;
  CLI::App app(
      "Keeps the jobs of skinframe: takes them from clients, gives them to workers, keeps their results.",
      "skinframe-server");
  app.footer(kExamples);
  app.set_version_flag("--version", "skinframe-server " SKINFRAME_VERSION);
  app.add_option("--listen", options.listen, "address:port; port 0 takes a free one")->capture_default_str();
  app.add_option("--data", options.data,
                 "folder for jobs and artifacts; made when absent; one server at a time");
  app.add_option("--tls-cert", options.tls_cert, "PEM certificate chain");
  app.add_option("--tls-key", options.tls_key, "PEM private key");
  app.add_flag("--allow-plaintext", options.allow_plaintext, "serve the network without TLS");
  app.add_option(
         "--store", options.store,
         "where jobs are kept: sqlite (in --data), or postgresql://USER@HOST/DATABASE, which any number "
         "of servers may share")
      ->capture_default_str();
  app.add_option(
      "--artifacts", options.artifacts,
      "folder of meshes and results; default DATA/artifacts; shared by all servers of one database");
  app.add_option("--lease,--lease-seconds", lease_seconds,
                 "seconds; a worker silent for so long loses its job")
      ->capture_default_str();
  app.add_option("--heartbeat,--heartbeat-seconds", heartbeat_seconds,
                 "seconds; a worker prolongs its lease at least this often")
      ->capture_default_str();
  app.add_option("--ageing", ageing_seconds, "seconds of waiting that weigh as much as one point of priority")
      ->capture_default_str();
  app.add_option("--max-attempts", options.policy.max_attempts, "lost attempts after which a job FAILED")
      ->capture_default_str();
  app.add_option("--queue-limit", options.queue_limit, "queued jobs beyond which submission is refused")
      ->capture_default_str();
  app.add_option("--keep-jobs-days", options.keep_jobs_days,
                 "an ended job is forgotten after so many days, its files a day later; 0: never")
      ->capture_default_str();
  app.add_option(
      "--profiles", options.profiles,
      "folder of printer and material profiles (*.json) beside the built-in ones; read again when it "
      "changes and on SIGHUP");
  app.add_option("--keep-progress-hours", options.keep_progress_hours,
                 "the progress of an ended job is forgotten after so many hours; 0: with the job")
      ->capture_default_str();
  app.add_option(
      "--tenants", options.tenants,
      "JSON file: whose caller is whose, shares, quotas, who works (server/README.md); read again when "
      "it changes and on SIGHUP");
  app.add_option("--client-ca", options.client_ca,
                 "PEM file; a caller's certificate that it has signed proves who calls");
  app.add_option("--drain", drain_seconds, "seconds that calls under way have left at a stop")
      ->capture_default_str();
  app.add_option("--port-file", options.port_file, "written with host:port once the server listens");
  app.add_option("--check-health", options.check_health,
                 "ask the server at this host:port of this machine how it is: 0 when it serves, 1 otherwise; "
                 "starts none");
  app.add_option(
      "--metrics", options.metrics,
      "serve Prometheus metrics at http://ADDRESS:PORT/metrics, in the clear; PORT alone is 127.0.0.1");
  take_from_surroundings(app, "SKINFRAME_SERVER_");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    int code = 0;
    const std::string text = text_of(app, error, code);
    return EarlyEnd{text, code == 0 ? 0 : 2};
  }
  for (const double seconds : {lease_seconds, heartbeat_seconds, ageing_seconds, drain_seconds}) {
    if (!std::isfinite(seconds) || std::abs(seconds) > 1e6)
      return EarlyEnd{"--lease, --heartbeat, --ageing and --drain must be plain numbers of seconds\n", 2};
  }
  options.policy.lease = from_seconds(lease_seconds);
  options.policy.heartbeat = from_seconds(heartbeat_seconds);
  options.policy.ageing = from_seconds(ageing_seconds);
  options.drain = from_seconds(drain_seconds);
  return options;
}

}  // namespace skinframe::server
