// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/job_runner.h"

#include <grpcpp/client_context.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <fstream>
#include <map>
#include <sstream>

#include "worker/agent/artifact_transfer.h"
#include "worker/agent/assignment.h"
#include "worker/agent/checkpoint_sender.h"
#include "worker/agent/completion_call.h"
#include "worker/agent/conclusion.h"
#include "worker/agent/heartbeater.h"
#include "worker/agent/supervise.h"
#include "worker/agent/wait.h"
#include "worker/agent/work_folder.h"
#include "worker/metrics/stage_times.h"

namespace skinframe::agent {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr std::uintmax_t kMaxOutcomeBytes = 1024 * 1024;
constexpr std::size_t kLastLogLines = 5;
constexpr std::size_t kLastLogLineBytes = 300;

class Attempt {
 public:
  Attempt(const AgentOptions& options, const fs::path& agent_folder, ServerStubs stubs,
          const v1::Assignment& assignment, std::stop_token worker_stop)
      : options_(options),
        agent_folder_(agent_folder),
        stubs_(stubs),
        assignment_(assignment),
        worker_stop_(worker_stop),
        heartbeater_(stubs.worker, assignment, std::move(worker_stop), *options.metrics) {}

  void run() {
    v1::CompleteRequest completion;
    options_.metrics->attempt_began();
    const Conclusion end = work(completion);
    stages_.end(steady_clock::now());
    heartbeater_.finish();
    const bool dropped = !end.report || heartbeater_.cause() == StopCause::kLeaseLost;
    options_.metrics->attempt_ended(dropped ? "DROPPED" : word_of(v1::JobState_Name(end.outcome.state)),
                                    dropped ? "DROPPED" : word_of(v1::Reason_Name(end.outcome.reason)));
    if (dropped) {
      spdlog::warn("job={} dropped: the lease is not ours any more", id());
      return;
    }
    completion.set_job_id(id());
    completion.set_fencing_token(assignment_.fencing_token());
    completion.set_state(end.outcome.state);
    completion.set_reason(end.outcome.reason);
    completion.set_detail(end.outcome.detail);
    completion.set_retryable(end.retryable);
    for (const v1::PrinterResult& printer : end.outcome.printers) *completion.add_printers() = printer;
    if (end.outcome.frame) *completion.mutable_frame() = *end.outcome.frame;
    send_completion(stubs_.worker, completion, assignment_.attempt(), heartbeater_, worker_stop_);
  }

 private:
  const std::string& id() const { return assignment_.job_id(); }
  LeaseProof proof() const { return {id(), assignment_.fencing_token()}; }

  // Fills in the completion's files.
  Conclusion work(v1::CompleteRequest& completion) {
    const auto folder = JobFolder::create(agent_folder_, id(), assignment_.fencing_token());
    if (!folder) return failed(v1::REASON_CRASHED, folder.error().message, true);
    if (auto wrong = prepare(folder->path())) return *std::move(wrong);
    AttemptEnd end = run_process(folder->path());
    read_outcome(folder->path() / "outcome.json", end);
    Conclusion conclusion = conclude(end);
    if (conclusion.upload && conclusion.report) {
      if (auto wrong = upload(folder->path() / "out", completion)) return *std::move(wrong);
    }
    return conclusion;
  }

  // How the attempt ended by a transfer that did not come through.
  Conclusion transfer_failed(const std::string& what, const grpc::Status& status) const {
    if (heartbeater_.cause() != StopCause::kNone) {
      AttemptEnd end;
      end.stop = heartbeater_.cause();
      return conclude(end);
    }
    return failed(v1::REASON_CRASHED, fmt::format("{}: {}", what, status.error_message()), true);
  }

  std::optional<Conclusion> prepare(const fs::path& folder) {
    std::map<std::string, fs::path> warm_start_files;
    if (auto wrong = fetch_warm_start(folder / "warm-start", warm_start_files)) return wrong;
    if (auto wrong = fetch_checkpoint(folder / "resume")) return wrong;
    const bool is_mesh = assignment_.spec().has_mesh_sha256();
    const fs::path input = folder / (is_mesh ? "mesh" : "problem.json");
    const auto request = job_request_json(assignment_, input, warm_start_files, options_.threads_per_job);
    if (!request) {
      const bool refused = request.error().kind == ErrorKind::kUnsupported;
      return failed(refused ? v1::REASON_UNSUPPORTED : v1::REASON_INTERNAL, request.error().message, false);
    }
    const grpc::Status fetched = download_artifact(stubs_.artifacts, input_sha256(assignment_.spec()), input,
                                                   heartbeater_.stop_token(), proof());
    if (!fetched.ok())
      return transfer_failed(
          is_mesh ? "the mesh could not be fetched" : "the frame problem could not be fetched", fetched);
    std::ofstream out(folder / "job.json");
    out << *request;
    out.close();
    if (!out) return failed(v1::REASON_CRASHED, "the worker's disk: job.json could not be written", true);
    return std::nullopt;
  }

  // What the server does not have any more is left out: the job then begins from nothing, and says so.
  std::optional<Conclusion> fetch_warm_start(const fs::path& folder, std::map<std::string, fs::path>& files) {
    const auto chosen = choose_warm_start_files(assignment_);
    if (chosen.empty()) return std::nullopt;
    std::error_code error;
    fs::create_directory(folder, error);
    if (error) return failed(v1::REASON_CRASHED, "the worker's disk: " + error.message(), true);
    for (const auto& [printer, file] : chosen) {
      const fs::path path = folder / (std::to_string(files.size()) + ".json");
      const grpc::Status fetched =
          download_artifact(stubs_.artifacts, file.sha256(), path, heartbeater_.stop_token(), proof());
      if (fetched.error_code() == grpc::StatusCode::NOT_FOUND) {
        spdlog::warn("job={} {} of the earlier job is gone", id(), file.path());
        continue;
      }
      if (!fetched.ok()) return transfer_failed("the earlier job's frame could not be fetched", fetched);
      files.emplace(printer, path);
    }
    return std::nullopt;
  }

  // One that is gone or damaged is done without, and said so.
  std::optional<Conclusion> fetch_checkpoint(const fs::path& path) {
    if (!assignment_.has_checkpoint()) return std::nullopt;
    const grpc::Status fetched = download_artifact(stubs_.artifacts, assignment_.checkpoint().sha256(), path,
                                                   heartbeater_.stop_token(), proof());
    if (fetched.ok()) return std::nullopt;
    std::error_code error;
    fs::remove(path, error);
    if (heartbeater_.cause() != StopCause::kNone)
      return transfer_failed("the checkpoint could not be fetched", fetched);
    v1::JobProgress note;
    note.set_stage("read");
    note.set_attempt(assignment_.attempt());
    note.set_note(
        "the checkpoint of an earlier attempt is not used: it could not be fetched; starting from the "
        "beginning");
    heartbeater_.add(std::move(note));
    spdlog::warn("job={} the checkpoint could not be fetched: {}", id(), fetched.error_message());
    return std::nullopt;
  }

  AttemptEnd run_process(const fs::path& folder) {
    AttemptEnd end;
    end.memory_limit_mb = options_.memory_limit_mb;
    ChildCommand command;
    command.program = options_.self_executable.string();
    command.arguments = {"skinframe-worker", "run-job", folder.string()};  // what `ps` shows
    if (options_.memory_limit_mb > 0) {
      command.address_space_bytes = static_cast<std::uint64_t>(options_.memory_limit_mb) << 20;
    }
    auto child = ChildProcess::start(command);
    if (!child) {
      end.exit.exit_code = 127;
      end.outcome_error = child.error().message;
      return end;
    }
    CheckpointSender checkpoints(stubs_, assignment_, folder);
    std::deque<std::string> last_lines;
    SuperviseOptions supervision;
    supervision.stop = heartbeater_.stop_token();
    supervision.on_stdout_line = [&](std::string_view line) { hear(line, checkpoints); };
    supervision.on_stderr_line = [&](std::string_view line) {
      spdlog::info("job={} | {}", id(), line);
      last_lines.emplace_back(line.substr(0, kLastLogLineBytes));
      if (last_lines.size() > kLastLogLines) last_lines.pop_front();
    };
    const Supervised ended = supervise(child.value(), supervision);
    if (ended.dropped_lines > 0) {
      spdlog::warn("job={} {} event lines were too long and dropped", id(), ended.dropped_lines);
    }
    end.exit = ended.exit;
    end.stop = heartbeater_.cause();
    for (const std::string& line : last_lines) {
      if (!end.last_log_lines.empty()) end.last_log_lines += " / ";
      end.last_log_lines += line;
    }
    end.last_log_lines = printable(std::move(end.last_log_lines));
    return end;
  }

  // stderr may hold anything; the API's texts are UTF-8.
  static std::string printable(std::string text) {
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E) c = '?';
    }
    return text;
  }

  void hear(std::string_view line, CheckpointSender& checkpoints) {
    auto event = parse_event_line(line);
    if (!event) {
      spdlog::warn("job={} event line dropped: {}", id(), event.error().message);
    } else if (auto* progress = std::get_if<v1::JobProgress>(&event.value())) {
      progress->set_attempt(assignment_.attempt());
      stages_.tell(progress->printer_id(), progress->stage(), progress->iteration(), steady_clock::now());
      heartbeater_.add(std::move(*progress));
    } else if (auto* ready = std::get_if<CheckpointReady>(&event.value())) {
      checkpoints.ready(std::move(ready->stage));
    } else {
      heartbeater_.add(std::get<v1::PrinterResult>(std::move(event).value()));
    }
  }

  static void read_outcome(const fs::path& path, AttemptEnd& end) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) return;  // none was written
    if (size > kMaxOutcomeBytes) {
      end.outcome_error = "outcome.json is larger than 1 MiB";
      return;
    }
    std::ifstream in(path, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    auto outcome = parse_outcome(text.str());
    if (outcome) {
      end.outcome = std::move(outcome).value();
    } else {
      end.outcome_error = outcome.error().message;
    }
  }

  std::optional<Conclusion> upload(const fs::path& out, v1::CompleteRequest& completion) {
    const auto files = list_result_files(out);
    if (!files) return failed(v1::REASON_INTERNAL, files.error().message, false);
    for (const fs::path& relative : *files) {
      const auto digest = digest_file(out / relative);
      if (!digest) return failed(v1::REASON_CRASHED, digest.error().message, true);
      if (digest->size_bytes == 0) continue;  // the store holds no empty artifact
      const grpc::Status sent =
          upload_artifact(stubs_.artifacts, out / relative, *digest, heartbeater_.stop_token(), proof());
      if (!sent.ok()) {
        completion.clear_files();
        return transfer_failed(fmt::format("result {} could not be uploaded", relative.string()), sent);
      }
      v1::ResultFile* file = completion.add_files();
      file->set_path(relative.generic_string());
      file->set_sha256(digest->sha256);
      file->set_size_bytes(digest->size_bytes);
    }
    return std::nullopt;
  }

  const AgentOptions& options_;
  const fs::path& agent_folder_;
  ServerStubs stubs_;
  const v1::Assignment& assignment_;
  const std::stop_token worker_stop_;
  Heartbeater heartbeater_;
  StageTimes stages_{*options_.metrics};
};

}  // namespace

void run_assignment(const AgentOptions& options, const fs::path& agent_folder, ServerStubs stubs,
                    const v1::Assignment& assignment, std::stop_token worker_stop) {
  const v1::JobSpec& spec = assignment.spec();
  if (spec.has_frame_problem_sha256()) {
    spdlog::info("job={} attempt {} begins: frame problem {}", assignment.job_id(), assignment.attempt(),
                 spec.mesh_name());
  } else {
    spdlog::info("job={} attempt {} begins: {} for {} printers", assignment.job_id(), assignment.attempt(),
                 spec.mesh_name(), spec.printers_size());
  }
  Attempt(options, agent_folder, stubs, assignment, std::move(worker_stop)).run();
}

}  // namespace skinframe::agent
