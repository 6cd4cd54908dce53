// SPDX-License-Identifier: Apache-2.0
#include "client/cli/verbs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "client/cli/embedded_farm.h"
#include "client/cli/follow.h"
#include "client/cli/interrupts.h"
#include "client/jobs/client.h"
#include "client/jobs/watch.h"
#include "client/present/event_line.h"
#include "client/present/job_table.h"
#include "client/present/json.h"
#include "client/present/progress_display.h"
#include "client/present/words.h"
#include "client/transfer/input_kind.h"
#include "client/transfer/upload.h"

namespace skinframe::client {
namespace {

// Upload and submission: all that happens before there is a job.
Result<v1::SubmitJobResponse> upload_and_submit(const Connection& connection, const JobArguments& job,
                                                v1::SubmitJobRequest request) {
  const auto file = upload_input(connection, job.mesh);
  if (!file) return file.failure();
  if (input_kind(job.mesh) == InputKind::kFrameProblem) {
    request.mutable_spec()->set_frame_problem_sha256(file->sha256);
  } else {
    request.mutable_spec()->set_mesh_sha256(file->sha256);
  }
  return submit_job(connection, std::move(request));
}

void tell_reuse(const v1::Job& job) {
  if (job.reused_job_id().empty()) return;
  fmt::print(stderr, "not run: job {} asked for the same, and its result is this job's; --no-reuse runs it\n",
             one_line(job.reused_job_id()));
}

ExitCode report_checks(const v1::SubmitJobResponse& response, bool json) {
  if (json) {
    print_json({{"valid", true}, {"checks", to_json(response)["checks"]}});
  } else {
    for (const std::string& check : response.checks()) fmt::print("{}\n", one_line(check));
  }
  return kExitSuccess;
}

// The part of `run` between the start of the farm and its end.
ExitCode run_on(EmbeddedFarm& farm, Interrupts& interrupts, const GlobalArguments& global,
                const RunArguments& arguments, const v1::SubmitJobRequest& request) {
  const auto address = farm.address();
  if (!address) return tell(address.failure());
  ConnectOptions options;
  options.address = *address;
  auto connection = connect(options);
  if (!connection) return tell(connection.failure());
  connection->stop = interrupts.stop_source().get_token();
  const auto cause = [&farm] { return farm.failure(); };
  const auto submitted = upload_and_submit(*connection, arguments.job, request);
  if (!submitted) return tell(cause().value_or(submitted.failure()));
  tell_reuse(submitted->job());
  return follow_job(*connection, interrupts, submitted->job().job_id(), {arguments.out, global.json, cause});
}

// One event of `watch` on stdout, the same wherever it is printed.
void print_event(const v1::JobEvent& event, bool json) {
  if (json) {
    fmt::print("{}\n", to_text(to_json(event), -1));
  } else {
    fmt::print("{}\n", event_line(event));
  }
  std::fflush(stdout);
}

// On a terminal progress is a bar; only what a person would want to scroll back to stays as a line.
class TerminalWatch {
 public:
  explicit TerminalWatch(ProgressDisplay& display) : display_(display) {}
  void show(const v1::JobEvent& event) {
    const std::string stage = event.progress().printer_id() + "/" + event.progress().stage();
    if (!event.has_progress() || stage != stage_ || !event.progress().note().empty()) {
      display_.finish();
      print_event(event, false);
    }
    if (event.has_progress()) {
      stage_ = stage;
      display_.show(event);
    }
  }

 private:
  ProgressDisplay& display_;
  std::string stage_;
};

}  // namespace

Result<Connection> open(const GlobalArguments& global, const Interrupts& interrupts) {
  auto connection = connect(global.server);
  if (connection) connection->stop = interrupts.stop_source().get_token();
  return connection;
}

ExitCode run(const GlobalArguments& global, const RunArguments& arguments) {
  const auto request = to_request(arguments.job);
  if (!request) return tell(request.failure());
  if (const auto file = digest_input_file(arguments.job.mesh); !file) return tell(file.failure());
  Interrupts interrupts;
  EmbeddedFarm farm(arguments.data, arguments.profiles, interrupts.stop_source());
  const ExitCode code = run_on(farm, interrupts, global, arguments, *request);
  if (code == kExitFailed || code == kExitUnreachable) {
    const auto logs = farm.keep_logs();  // empty: a program is missing, there are none
    if (!logs.empty()) fmt::print(stderr, "The logs of server and worker are in {}\n", logs.string());
  }
  return code;
}

ExitCode submit(const GlobalArguments& global, const SubmitArguments& arguments) {
  const auto request = to_request(arguments.job);
  if (!request) return tell(request.failure());
  Interrupts interrupts;
  const auto connection = open(global, interrupts);
  if (!connection) return tell(connection.failure());
  const auto submitted = upload_and_submit(*connection, arguments.job, *request);
  if (!submitted) return tell(submitted.failure());
  if (request->validate_only()) return report_checks(*submitted, global.json);
  const std::string& id = submitted->job().job_id();
  tell_reuse(submitted->job());
  if (arguments.watch) {
    fmt::print(stderr, "job {}\n", one_line(id));
    return follow_job(*connection, interrupts, id, {arguments.out, global.json});
  }
  if (global.json) {
    print_json({{"job_id", id}});
  } else {
    fmt::print("{}\n", one_line(id));
    if (submitted->has_queued_before() && submitted->queued_before() > 0) {
      fmt::print(stderr, "{} jobs stand before it\n", submitted->queued_before());
    }
  }
  return kExitSuccess;
}

ExitCode watch(const GlobalArguments& global, const std::string& job_id, std::int64_t after_sequence) {
  Interrupts interrupts;
  const auto connection = open(global, interrupts);
  if (!connection) return tell(connection.failure());
  // Asked first: whether the job and the server exist is known at once, and only then is patience in place.
  if (const auto known = get_job(*connection, job_id); !known) return tell(known.failure());
  const bool as_lines = global.json || ::isatty(STDOUT_FILENO) != 1;
  ProgressDisplay display(stderr, ::isatty(STDERR_FILENO) == 1, *connection->clock);
  TerminalWatch terminal(display);
  WatchOptions options;
  options.after_sequence = after_sequence;
  options.on_lost = [&] { display.say("the server does not answer; watching again as soon as it does"); };
  options.on_thinned = [&](std::int64_t first, std::int64_t last) {
    display.say(fmt::format(
        "events {} to {} are gone: the server keeps the progress of an ended job for a while", first, last));
  };
  const auto watched = watch_job(*connection, job_id, options, [&](const v1::JobEvent& event) {
    if (as_lines) {
      print_event(event, global.json);
    } else {
      terminal.show(event);
    }
    return std::ferror(stdout) == 0;
  });
  display.finish();
  if (!watched && watched.failure().kind == FailureKind::kInterrupted) {
    fmt::print(stderr, "detached; the job goes on (skinframe watch {})\n", one_line(job_id));
    return kExitSuccess;
  }
  if (!watched) return tell(watched.failure());
  const auto job = get_job(*connection, job_id);
  if (!job) return tell(job.failure());
  if (job->state() != v1::JOB_STATE_SUCCEEDED || job->reason() != v1::REASON_UNSPECIFIED) {
    fmt::print(stderr, "skinframe: {}", end_report(*job));
  }
  return exit_code(job->state(), job->reason());
}

}  // namespace skinframe::client
