// SPDX-License-Identifier: Apache-2.0
#include "client/present/progress_display.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "client/present/event_line.h"
#include "client/present/words.h"

namespace skinframe::client {
namespace {

constexpr std::chrono::seconds kLinePeriod{2};
constexpr std::size_t kBarWidth = 16;

// The stages in order, as job.proto names them. How far the work is: by stage, since the time a stage takes
// depends on the mesh.
constexpr std::array<std::string_view, 10> kStages = {"read", "repair",   "skin",     "stress", "sample",
                                                      "size", "topology", "geometry", "export", "verify"};

std::size_t terminal_columns(std::FILE* out) {
  winsize size{};
  if (::ioctl(::fileno(out), TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

}  // namespace

std::string progress_bar(const v1::JobProgress& progress, std::size_t columns) {
  const auto stage = std::find(kStages.begin(), kStages.end(), progress.stage());
  const auto reached = stage == kStages.end() ? 0 : static_cast<std::size_t>(stage - kStages.begin()) + 1;
  const std::size_t full = kBarWidth * reached / kStages.size();
  std::string out = fmt::format("[{}{}] {}", std::string(full, '#'), std::string(kBarWidth - full, '.'),
                                progress_text(progress));
  if (out.size() >= columns)
    out.resize(columns - 1);  // one column less: the last one wraps on some terminals
  return out;
}

void ProgressDisplay::show(const v1::JobEvent& event) {
  const std::lock_guard lock(mutex_);
  if (paused_) return;
  if (!event.has_progress() || !event.progress().note().empty()) {
    line(event_text(event));
    return;
  }
  const v1::JobProgress& progress = event.progress();
  if (terminal_) {
    fmt::print(out_, "\r{}\x1b[K", progress_bar(progress, terminal_columns(out_)));
    std::fflush(out_);
    bar_shown_ = true;
    return;
  }
  Told& told = told_[progress.printer_id()];
  const auto now = clock_.now();
  if (progress.stage() == told.stage && now - told.at < kLinePeriod) return;
  told.stage = progress.stage();
  told.at = now;
  // The estimated rest alone is no news: a log shall not repeat itself while a stage has nothing to tell.
  v1::JobProgress known = progress;
  known.clear_seconds_left();
  const std::string text = progress_text(known);
  if (text == told.text) return;
  told.text = text;
  line(progress_text(progress));
}

void ProgressDisplay::say(const std::string& text) {
  const std::lock_guard lock(mutex_);
  line(text);
}

void ProgressDisplay::pause(bool paused) {
  const std::lock_guard lock(mutex_);
  clear_bar();
  paused_ = paused;
}

void ProgressDisplay::finish() {
  const std::lock_guard lock(mutex_);
  clear_bar();
}

void ProgressDisplay::line(const std::string& text) {
  clear_bar();
  fmt::print(out_, "{}\n", text);
  std::fflush(out_);
}

void ProgressDisplay::clear_bar() {
  if (!bar_shown_) return;
  fmt::print(out_, "\r\x1b[K");
  std::fflush(out_);
  bar_shown_ = false;
}

}  // namespace skinframe::client
