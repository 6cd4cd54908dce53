// SPDX-License-Identifier: GPL-3.0-or-later
// The job's side of the pipe: one JSON object a line, as README.md of this folder gives it. Ticks are thinned
// to one every kTickSeconds; a change of stage, and everything that is not a tick, goes at once. A beat
// repeats the last tick while a stage is silent, so that a line comes at least every 500 ms.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "worker/pipeline/pipeline.h"

namespace skinframe {

inline constexpr double kTickSeconds = 0.2;
inline constexpr double kBeatSeconds = 0.4;

// Whether the time left can be told. A frame problem's stages have no usual share of it.
enum class TimeLeft { kEstimated, kUnknown };

nlohmann::json progress_json(const PipelineProgress& progress, std::optional<double> seconds_left);
nlohmann::json outcome_json(const PrinterOutcome& outcome);

class EventStream {
 public:
  explicit EventStream(std::FILE* out, TimeLeft time_left = TimeLeft::kEstimated);
  ~EventStream();  // stops the beat; writes nothing more

  void progress(const PipelineProgress& progress);
  void printer_ended(const PrinterOutcome& outcome);
  void note(const std::string& text);         // a sentence for people, beside the present stage
  void checkpoint(const std::string& stage);  // WORKDIR/checkpoint is new

 private:
  using Clock = std::chrono::steady_clock;
  void write_line(const nlohmann::json& line);  // mutex_ held
  void beat(std::stop_token stop);

  std::FILE* out_;
  const TimeLeft time_left_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  // Printers may run side by side: what was told of each, and of the stages they share under "".
  struct Told {
    PipelineProgress last;
    Clock::time_point written, started;
  };
  std::map<std::string, Told> told_;
  std::optional<PipelineProgress> last_;  // of any
  Clock::time_point last_written_ = Clock::now();
  std::jthread beat_;
};

}  // namespace skinframe
