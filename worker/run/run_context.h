// SPDX-License-Identifier: GPL-3.0-or-later
// What every stage gets beside its input and its options: cancellation, progress, seed, thread budget.
// Same input, seed and version give the same result at any thread count.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "worker/run/result.h"

namespace skinframe {

// The stages a user sees, in order. Names of the wire: to_string().
enum class Stage { kRead, kRepair, kSkin, kStress, kSample, kSize, kTopology, kGeometry, kExport, kVerify };

inline const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::kRead:
      return "read";
    case Stage::kRepair:
      return "repair";
    case Stage::kSkin:
      return "skin";
    case Stage::kStress:
      return "stress";
    case Stage::kSample:
      return "sample";
    case Stage::kSize:
      return "size";
    case Stage::kTopology:
      return "topology";
    case Stage::kGeometry:
      return "geometry";
    case Stage::kExport:
      return "export";
    case Stage::kVerify:
      return "verify";
  }
  return "unknown";
}

// One tick of progress. What is not known yet stays empty, never zero.
struct Progress {
  Stage stage = Stage::kRead;
  int iteration = 0;                       // of the stage's own loop; 0 where it has none
  std::optional<double> frame_volume_mm3;  // nominal, sum of pi r^2 l
  std::optional<double> violation;         // worst relative constraint violation of the current iterate
  std::optional<int> struts_left;
};

struct RunContext {
  std::stop_token stop;
  std::function<void(const Progress&)> report = [](const Progress&) {};
  std::uint64_t seed = 1;
  int threads = 1;

  bool cancelled() const { return stop.stop_requested(); }
};

inline Error cancelled_error() { return {ErrorKind::kCancelled, "the job was cancelled"}; }

}  // namespace skinframe
