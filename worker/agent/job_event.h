// SPDX-License-Identifier: GPL-3.0-or-later
// From the job process's words to the server's: event lines and outcome.json (worker/job/README.md).
// The job has read a stranger's mesh, so what it says is hostile input: wrong types, unknown words, numbers
// that are not finite and texts without end become an Error or are cut, never a crash.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "skinframe/v1/job.pb.h"
#include "worker/run/result.h"

namespace skinframe::agent {

inline constexpr std::size_t kMaxDetailBytes = 4096;  // longer texts are cut
inline constexpr std::size_t kMaxNoteBytes = 512;     // likewise

// WORKDIR/checkpoint is new, with this stage finished.
struct CheckpointReady {
  std::string stage;
};

using JobLine = std::variant<v1::JobProgress, v1::PrinterResult, CheckpointReady>;

// One line of the job's stdout. What the line leaves out stays absent.
Result<JobLine> parse_event_line(std::string_view line);

struct Outcome {
  v1::JobState state = v1::JOB_STATE_UNSPECIFIED;  // SUCCEEDED, FAILED or CANCELLED
  v1::Reason reason = v1::REASON_UNSPECIFIED;
  std::string detail;
  std::vector<v1::PrinterResult> printers;
  std::optional<v1::FrameResult> frame;  // of a frame problem
};

Result<Outcome> parse_outcome(std::string_view text);

}  // namespace skinframe::agent
