// SPDX-License-Identifier: Apache-2.0
// skinframe-server: see --help and server/README.md.
#include <grpc/support/log.h>
#include <pthread.h>
#include <signal.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <string>
#include <variant>

#include "server/app/check_health.h"
#include "server/app/options.h"
#include "server/app/server.h"

namespace {

using namespace skinframe::server;

// Before any thread starts, so that all threads inherit it and only sigwait() sees the signals.
sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return signals;
}

// gRPC tells only here why a TLS handshake failed. Before the server listens its lines would stand beside our
// own sentence, and say the same at ten times the length.
void drop_grpc_line(gpr_log_func_args*) {}
void log_grpc_line(gpr_log_func_args* line) {
  if (line->severity == GPR_LOG_SEVERITY_ERROR) spdlog::warn("grpc: {}", line->message);
}

int fail(const absl::Status& status, int exit_code) {
  std::fprintf(stderr, "skinframe-server: %s\n", std::string(status.message()).c_str());
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  const sigset_t signals = block_signals();
  const auto parsed = parse_command_line(argc, argv);
  if (const auto* end = std::get_if<EarlyEnd>(&parsed)) {
    std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr);
    return end->exit_code;
  }
  const auto& options = std::get<ServerOptions>(parsed);
  if (!options.check_health.empty()) {
    gpr_set_log_function(drop_grpc_line);
    const auto status = check_health(options.check_health);
    return status.ok() ? 0 : fail(status, 1);
  }
  if (const auto status = options.validate(); !status.ok()) return fail(status, 2);

  spdlog::set_default_logger(spdlog::stderr_color_mt("server"));
  gpr_set_log_function(drop_grpc_line);
  const SystemClock clock;
  RandomIds ids;
  auto server = Server::start(options, clock, ids);
  if (!server.ok()) return fail(server.status(), 1);
  gpr_set_log_function(log_grpc_line);
  spdlog::info("skinframe-server {} listens on {}, data in {}", SKINFRAME_VERSION, (*server)->address(),
               options.data.string());
  if (options.tls_cert.empty() && options.allow_plaintext) {
    spdlog::warn("without TLS: whoever can reach {} can read and submit jobs", (*server)->address());
  }
  int signal_number = 0;
  while (sigwait(&signals, &signal_number) == 0 && signal_number == SIGHUP) (*server)->reload();
  spdlog::info("stopping on {}", signal_number == SIGINT ? "SIGINT" : "SIGTERM");
  (*server)->stop();
  spdlog::info("stopped");
  return 0;
}
