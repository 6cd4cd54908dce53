// SPDX-License-Identifier: Apache-2.0
#include "server/retention/progress_thinning.h"

namespace skinframe::server {
namespace {
constexpr int kMostAtOnce = 5;  // one transaction, behind which every other write waits
}

absl::Status ProgressThinning::run_once(Time now) {
  if (now >= looked_ && now - looked_ < every_) return absl::OkStatus();
  const auto thinned = store_.thin_progress(now - keep_, kMostAtOnce);
  if (!thinned.ok()) return thinned.status();
  if (*thinned < kMostAtOnce) looked_ = now;  // else the rest has its turn in the next round
  return absl::OkStatus();
}

}  // namespace skinframe::server
