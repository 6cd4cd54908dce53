// SPDX-License-Identifier: Apache-2.0
#include "client/cli/follow.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <stop_token>
#include <thread>

#include "client/jobs/client.h"
#include "client/jobs/watch.h"
#include "client/present/job_table.h"
#include "client/present/json.h"
#include "client/present/progress_display.h"
#include "client/transfer/download.h"

namespace skinframe::client {
namespace {

// What a signal means while a job is followed. The call that cancels has a thread of its own, so that a
// further signal is heard while it hangs.
class CancelOnSignal {
 public:
  CancelOnSignal(const Connection& connection, Interrupts& interrupts, ProgressDisplay& display,
                 std::string job_id)
      : connection_(connection), interrupts_(interrupts), display_(display), job_id_(std::move(job_id)) {}

  void operator()(int signal) {
    if (cancelling_.joinable()) {
      cancelling_.request_stop();
      leave();
      return;
    }
    if (signal == SIGINT && ::isatty(STDIN_FILENO) == 1 && ::isatty(STDERR_FILENO) == 1) {
      display_.pause(true);
      const Answer answer = interrupts_.ask("\nCancel the job? [y/N] ");
      if (answer == Answer::kSignal) std::fputs("\n", stderr);  // nobody has ended the question's line
      display_.pause(false);
      if (answer == Answer::kNo) return;
    }
    display_.say("cancelling the job");
    cancelling_ = std::jthread([this](const std::stop_token& stop) {
      const auto cancelled = cancel_job(connection_.with_stop(stop), job_id_);
      if (cancelled || stop.stop_requested()) return;  // the watch sees the end, or nobody waits for it
      display_.say("skinframe: " + cancelled.failure().message);
      leave();
    });
  }

 private:
  void leave() { std::stop_source(interrupts_.stop_source()).request_stop(); }

  const Connection& connection_;
  Interrupts& interrupts_;
  ProgressDisplay& display_;
  std::string job_id_;
  std::jthread cancelling_;  // last: its end is waited for while the rest is there
};

// Whether the end needs words beyond the table.
bool all_well(v1::JobState state, v1::Reason reason) {
  return state == v1::JOB_STATE_SUCCEEDED && reason == v1::REASON_UNSPECIFIED;
}

Done watch_with_display(const Connection& connection, Interrupts& interrupts, const std::string& job_id) {
  ProgressDisplay display(stderr, ::isatty(STDERR_FILENO) == 1, *connection.clock);
  CancelOnSignal cancel(connection, interrupts, display, job_id);
  const Interrupts::Handling handling(interrupts, [&](int signal) { cancel(signal); });
  WatchOptions options;
  options.on_lost = [&] { display.say("the server does not answer; watching again as soon as it does"); };
  return watch_job(connection, job_id, options, [&](const v1::JobEvent& event) {
    const bool reported_later = event.has_state() && is_final(event.state().state()) &&
                                !all_well(event.state().state(), event.state().reason());
    if (!reported_later) display.show(event);
    return true;
  });
}

void report(const v1::Job& job, bool json) {
  if (json) {
    print_json(to_json(job));
  } else {
    fmt::print("{}", result_table(job));
  }
  std::fflush(stdout);
  if (!all_well(job.state(), job.reason())) {
    fmt::print(stderr, "skinframe: {}", end_report(job));
  }
}

}  // namespace

ExitCode tell(const Failure& failure) {
  fmt::print(stderr, "skinframe: {}\n", failure.message);
  return exit_code(failure.kind);
}

ExitCode follow_job(const Connection& connection, Interrupts& interrupts, const std::string& job_id,
                    const FollowOptions& options) {
  const auto tell_cause = [&](const Failure& failure) {
    return tell(options.cause ? options.cause().value_or(failure) : failure);
  };
  if (const auto watched = watch_with_display(connection, interrupts, job_id); !watched)
    return tell_cause(watched.failure());
  const auto job = get_job(connection, job_id);
  if (!job) return tell_cause(job.failure());
  ExitCode code = exit_code(job->state(), job->reason());
  std::size_t files = 0;
  if (!options.out.empty() && job->files_size() > 0) {
    const auto written = download_results(connection, *job, options.out);
    if (written) {
      files = written->size();
    } else {
      const ExitCode failed = tell_cause(written.failure());
      if (code == kExitSuccess || code == kExitPartial) code = failed;
    }
  }
  report(*job, options.json);
  if (files > 0) fmt::print(stderr, "{} files in {}\n", files, options.out.string());
  return code;
}

}  // namespace skinframe::client
