// SPDX-License-Identifier: Apache-2.0
#include "server/api/worker_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

namespace skinframe::server {
namespace {

constexpr std::int64_t kLargestCheckpoint = std::int64_t{64} << 20;
constexpr std::size_t kLongestNote = 512;
constexpr std::size_t kLongestId = 128;
constexpr std::size_t kLongestWord = 128;  // a stage, a material, a verdict
constexpr std::size_t kLongestDetail = 4096;
constexpr std::size_t kLongestPath = 255;
constexpr int kMostProgress = 100;
constexpr int kMostPrinters = 16;
constexpr int kMostFiles = 1000;
constexpr int kMostFrameStages = 16;

template <class... Args>
absl::Status invalid(fmt::format_string<Args...> format, Args&&... args) {
  return absl::InvalidArgumentError(fmt::format(format, std::forward<Args>(args)...));
}

absl::Status check_word(const char* field, const std::string& word) {
  if (word.size() <= kLongestWord) return absl::OkStatus();
  return invalid("{} has {} bytes, at most {} are allowed", field, word.size(), kLongestWord);
}

template <class Results>
absl::Status check_printers(const Results& printers) {
  if (printers.size() > kMostPrinters) return invalid("printers has more than {} entries", kMostPrinters);
  for (const v1::PrinterResult& printer : printers) {
    if (printer.printer_id().empty() || printer.printer_id().size() > kLongestId) {
      return invalid("printers.printer_id must have 1 .. {} bytes", kLongestId);
    }
    if (printer.detail().size() > kLongestDetail) {
      return invalid("printers.detail has {} bytes, at most {} are allowed", printer.detail().size(),
                     kLongestDetail);
    }
    if (auto s = check_word("printers.material_id", printer.material_id()); !s.ok()) return s;
    if (auto s = check_word("printers.statistics.balance", printer.statistics().balance()); !s.ok()) return s;
  }
  return absl::OkStatus();
}

absl::Status check_printer_is_asked_for(const v1::JobSpec& spec, const std::string& printer_id) {
  const auto& asked = spec.printers();
  const bool found = std::any_of(asked.begin(), asked.end(), [&](const v1::PrinterRequest& printer) {
    return printer.printer_id() == printer_id;
  });
  if (found) return absl::OkStatus();
  return invalid("printer_id \"{}\" is not one that the job asks for", printer_id);
}

absl::Status check_frame(const v1::FrameResult& frame) {
  if (frame.stages_size() > kMostFrameStages)
    return invalid("frame.stages has {} entries, at most {} are allowed", frame.stages_size(),
                   kMostFrameStages);
  for (const v1::FrameStage& stage : frame.stages())
    if (auto s = check_word("frame.stages.stage", stage.stage()); !s.ok()) return s;
  if (auto s = check_word("frame.mechanics", frame.mechanics()); !s.ok()) return s;
  return check_word("frame.violated_constraint", frame.violated_constraint());
}

// Relative, each part a plain name: it becomes a file below the client's folder.
bool is_safe_path(std::string_view path) {
  if (path.empty() || path.size() > kLongestPath || path.find('\0') != std::string_view::npos) return false;
  if (path.find('\\') != std::string_view::npos) return false;
  while (!path.empty()) {
    const std::size_t end = path.find('/');
    const std::string_view part = path.substr(0, end);
    if (part.empty() || part == "." || part == "..") return false;
    if (end == std::string_view::npos) return true;
    path.remove_prefix(end + 1);
  }
  return false;  // ends with a slash
}

}  // namespace

absl::Status validate_lease(const v1::LeaseRequest& request) {
  if (request.worker_id().empty() || request.worker_id().size() > kLongestId) {
    return invalid("worker_id must have 1 .. {} bytes", kLongestId);
  }
  if (request.instance_id().empty() || request.instance_id().size() > kLongestId) {
    return invalid("instance_id must have 1 .. {} bytes", kLongestId);
  }
  return absl::OkStatus();
}

absl::Status validate_heartbeat(const v1::HeartbeatRequest& request) {
  if (request.progress_size() > kMostProgress) {
    return invalid("progress has {} entries, at most {} are allowed", request.progress_size(), kMostProgress);
  }
  for (const v1::JobProgress& progress : request.progress()) {
    if (auto status = check_word("progress.printer_id", progress.printer_id()); !status.ok()) return status;
    if (auto status = check_word("progress.stage", progress.stage()); !status.ok()) return status;
    if (progress.note().size() > kLongestNote)
      return invalid("progress.note has {} bytes, at most {} are allowed", progress.note().size(),
                     kLongestNote);
  }
  return check_printers(request.printers());
}

absl::Status validate_checkpoint(const v1::CheckpointRequest& request) {
  const v1::Checkpoint& checkpoint = request.checkpoint();
  if (!is_sha256(checkpoint.sha256())) return invalid("checkpoint.sha256 is not a SHA-256");
  if (checkpoint.size_bytes() < 1 || checkpoint.size_bytes() > kLargestCheckpoint) {
    return invalid("checkpoint.size_bytes is {}, must be within 1 .. {}", checkpoint.size_bytes(),
                   kLargestCheckpoint);
  }
  return check_word("checkpoint.stage", checkpoint.stage());
}

absl::Status validate_complete(const v1::CompleteRequest& request) {
  const v1::JobState state = request.state();
  if (state != v1::JOB_STATE_SUCCEEDED && state != v1::JOB_STATE_FAILED && state != v1::JOB_STATE_CANCELLED) {
    return invalid("state must be SUCCEEDED, FAILED or CANCELLED");
  }
  const v1::Reason reason = request.reason();
  if (!v1::Reason_IsValid(reason)) return invalid("reason {} is unknown", static_cast<int>(reason));
  if (state == v1::JOB_STATE_SUCCEEDED && reason != v1::REASON_UNSPECIFIED && reason != v1::REASON_PARTIAL) {
    return invalid("reason with SUCCEEDED must be none or PARTIAL");
  }
  if (state == v1::JOB_STATE_FAILED && reason == v1::REASON_UNSPECIFIED)
    return invalid("FAILED needs a reason");
  const bool attempt_failed = reason == v1::REASON_CRASHED || reason == v1::REASON_OUT_OF_MEMORY;
  if (request.retryable() && !(state == v1::JOB_STATE_FAILED && attempt_failed)) {
    return invalid("retryable needs FAILED with CRASHED or OUT_OF_MEMORY");
  }
  if (request.detail().size() > kLongestDetail) {
    return invalid("detail has {} bytes, at most {} are allowed", request.detail().size(), kLongestDetail);
  }
  if (request.files_size() > kMostFiles) return invalid("files has more than {} entries", kMostFiles);
  std::set<std::string_view> paths;
  for (const v1::ResultFile& file : request.files()) {
    if (!is_safe_path(file.path()))
      return invalid("files.path \"{}\" is not a plain relative path", file.path());
    if (!is_sha256(file.sha256())) return invalid("files.sha256 of \"{}\" is not a SHA-256", file.path());
    if (!paths.insert(file.path()).second) return invalid("files.path \"{}\" is there twice", file.path());
  }
  if (auto status = check_frame(request.frame()); !status.ok()) return status;
  return check_printers(request.printers());
}

absl::Status printers_are_the_jobs(const v1::JobSpec& spec, const v1::HeartbeatRequest& request) {
  for (const v1::JobProgress& progress : request.progress()) {
    if (progress.printer_id().empty()) continue;  // a stage that all printers share
    if (auto status = check_printer_is_asked_for(spec, progress.printer_id()); !status.ok()) return status;
  }
  for (const v1::PrinterResult& printer : request.printers()) {
    if (auto status = check_printer_is_asked_for(spec, printer.printer_id()); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status printers_are_the_jobs(const v1::JobSpec& spec, const v1::CompleteRequest& request) {
  if (request.has_frame() && !spec.has_frame_problem_sha256())
    return invalid("frame is there, but the job is of a mesh");
  for (const v1::PrinterResult& printer : request.printers()) {
    if (auto status = check_printer_is_asked_for(spec, printer.printer_id()); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status files_are_there(const v1::CompleteRequest& request, const ArtifactStore& artifacts) {
  for (const v1::ResultFile& file : request.files()) {
    const auto facts = artifacts.stat(file.sha256());
    if (!facts.ok()) return facts.status();
    if (!facts->complete) {
      return absl::FailedPreconditionError(
          fmt::format("file \"{}\" ({}) is not uploaded", file.path(), file.sha256()));
    }
    if (facts->size_bytes != file.size_bytes()) {
      return absl::FailedPreconditionError(
          fmt::format("file \"{}\" has {} bytes, not {}", file.path(), facts->size_bytes, file.size_bytes()));
    }
  }
  return absl::OkStatus();
}

}  // namespace skinframe::server
