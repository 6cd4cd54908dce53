// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/event_stream.h"

#include <cmath>

namespace skinframe {
namespace {

using nlohmann::json;

// Share of a printer's time that is behind when a stage begins: medians of runs on 200 mm bodies. Only the
// estimate of the time left rests on it.
double share_behind(Stage stage) {
  switch (stage) {
    case Stage::kRead:
      return 0.0;
    case Stage::kRepair:
      return 0.02;
    case Stage::kSkin:
      return 0.05;
    case Stage::kStress:
      return 0.15;
    case Stage::kSample:
      return 0.2;
    case Stage::kSize:
      return 0.4;
    case Stage::kTopology:
      return 0.5;
    case Stage::kGeometry:
      return 0.6;
    case Stage::kExport:
      return 0.65;
    case Stage::kVerify:
      return 0.8;
  }
  return 0.0;
}

constexpr double kEnoughToEstimate = 0.1;  // of a printer's time: before that it would be a guess

template <class T>
void put(json& object, const char* key, const std::optional<T>& value) {
  if (value) object[key] = *value;
}

}  // namespace

json progress_json(const PipelineProgress& event, std::optional<double> seconds_left) {
  const Progress& p = event.progress;
  json out = {{"stage", to_string(p.stage)}, {"iteration", p.iteration}};
  if (!event.printer.empty()) out["printer"] = event.printer;
  put(out, "frame_volume_mm3", p.frame_volume_mm3);
  put(out, "skin_volume_mm3", event.skin_volume_mm3);
  if (p.frame_volume_mm3 && event.skin_volume_mm3) {
    const double total = *p.frame_volume_mm3 + *event.skin_volume_mm3;
    out["total_volume_mm3"] = total;
    if (event.solid_volume_mm3) out["ratio"] = total / *event.solid_volume_mm3;
  }
  put(out, "struts_left", p.struts_left);
  if (p.violation && std::isfinite(*p.violation)) out["violation"] = *p.violation;
  put(out, "seconds_left", seconds_left);
  return {{"progress", out}};
}

json outcome_json(const PrinterOutcome& outcome) {
  json out = {{"printer", outcome.printer},
              {"material", outcome.material},
              {"state", outcome.succeeded() ? "SUCCEEDED" : "FAILED"},
              {"reason", to_string(outcome.reason)},
              {"detail", outcome.detail}};
  put(out, "best_reachable_displacement_mm", outcome.best_reachable_displacement_mm);
  if (outcome.statistics) out["statistics"] = to_json(*outcome.statistics);
  return out;
}

EventStream::EventStream(std::FILE* out, TimeLeft time_left)
    : out_(out), time_left_(time_left), beat_([this](std::stop_token stop) { beat(stop); }) {}

EventStream::~EventStream() {
  beat_.request_stop();
  wake_.notify_all();
}

void EventStream::progress(const PipelineProgress& event) {
  const std::scoped_lock lock(mutex_);
  const auto now = Clock::now();
  const auto [entry, first] = told_.try_emplace(event.printer, Told{event, now, now});
  Told& told = entry->second;
  const bool new_stage = first || told.last.progress.stage != event.progress.stage;
  const bool due = std::chrono::duration<double>(now - told.written).count() >= kTickSeconds;
  told.last = event;
  last_ = event;
  if (!new_stage && !due) return;
  std::optional<double> seconds_left;
  const double before = share_behind(Stage::kSkin);  // where a printer's own stages begin
  const double behind = (share_behind(event.progress.stage) - before) / (1 - before);
  if (time_left_ == TimeLeft::kEstimated && !event.printer.empty() && behind > kEnoughToEstimate)
    seconds_left = std::chrono::duration<double>(now - told.started).count() * (1 - behind) / behind;
  told.written = now;
  write_line(progress_json(event, seconds_left));
}

void EventStream::printer_ended(const PrinterOutcome& outcome) {
  const std::scoped_lock lock(mutex_);
  write_line({{"printer", outcome_json(outcome)}});
}

void EventStream::note(const std::string& text) {
  const std::scoped_lock lock(mutex_);
  json line = {{"stage", to_string(last_ ? last_->progress.stage : Stage::kRead)}, {"note", text}};
  if (last_ && !last_->printer.empty()) line["printer"] = last_->printer;
  write_line({{"progress", std::move(line)}});
}

void EventStream::checkpoint(const std::string& stage) {
  const std::scoped_lock lock(mutex_);
  write_line({{"checkpoint", {{"stage", stage}}}});
}

void EventStream::write_line(const json& line) {
  // A reader that is gone is the agent's death; the parent-death signal ends this process.
  const std::string text = line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  std::fwrite(text.data(), 1, text.size(), out_);
  std::fflush(out_);
  last_written_ = Clock::now();
}

void EventStream::beat(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  const auto period = std::chrono::duration<double>(kBeatSeconds);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, period, [] { return false; });
    if (stop.stop_requested() || !last_ || Clock::now() - last_written_ < period) continue;
    write_line(progress_json(*last_, std::nullopt));
  }
}

}  // namespace skinframe
