// SPDX-License-Identifier: GPL-3.0-or-later
// One attempt's stages and iterations, as its progress tells of them, into the worker's metrics. A stage of
// one printer lasts until that printer's next one; a stage that all printers share lasts until the first
// printer's. What the job's process says is a stranger's: stages that are none of ours count as "other". Not
// thread-safe.
#pragma once

#include <chrono>
#include <map>
#include <string>

#include "worker/metrics/worker_metrics.h"

namespace skinframe {

class StageTimes {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit StageTimes(WorkerMetrics& metrics) : metrics_(metrics) {}

  // printer: empty where all share the stage.
  void tell(const std::string& printer, const std::string& stage, int iteration, TimePoint now);
  void end(TimePoint now);  // of the attempt

 private:
  struct Current {
    std::string stage;
    TimePoint since;
    int iteration = 0;
  };
  void close(const Current& current, TimePoint now);

  WorkerMetrics& metrics_;
  std::map<std::string, Current> current_;  // by printer
};

}  // namespace skinframe
