// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/metrics/stage_times.h"

#include <algorithm>
#include <array>

namespace skinframe {
namespace {

constexpr std::array kStages = {"read", "repair",   "skin",     "stress", "sample",
                                "size", "topology", "geometry", "export", "verify"};
constexpr std::size_t kMostPrinters = 64;

std::string known(const std::string& stage) {
  return std::find(kStages.begin(), kStages.end(), stage) == kStages.end() ? "other" : stage;
}

}  // namespace

void StageTimes::tell(const std::string& printer, const std::string& stage, int iteration, TimePoint now) {
  const std::string name = known(stage);
  if (!printer.empty()) {
    if (const auto shared = current_.find(""); shared != current_.end()) {
      close(shared->second, now);
      current_.erase(shared);
    }
  }
  if (current_.size() >= kMostPrinters && !current_.contains(printer)) return;
  const auto [at, is_new] = current_.try_emplace(printer, Current{name, now, 0});
  Current& current = at->second;
  if (!is_new && current.stage != name) {
    close(current, now);
    current = {name, now, 0};
  }
  if (iteration > current.iteration) metrics_.iterated(name, iteration - current.iteration);
  current.iteration = std::max(iteration, 0);  // a pass that begins anew counts anew
}

void StageTimes::end(TimePoint now) {
  for (const auto& [printer, current] : current_) close(current, now);
  current_.clear();
}

void StageTimes::close(const Current& current, TimePoint now) {
  metrics_.stage_took(current.stage, std::chrono::duration<double>(now - current.since).count());
}

}  // namespace skinframe
