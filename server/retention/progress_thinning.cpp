// SPDX-License-Identifier: Apache-2.0
#include "server/retention/progress_thinning.h"

namespace skinframe::server {
namespace {
constexpr int kMostAtOnce = 5;  // one transaction, behind which every other write waits
}

absl::StatusOr<bool> ProgressThinning::sweep(JobStore& store, Time ended_before) {
  const auto thinned = store.thin_progress(ended_before, kMostAtOnce);
  if (!thinned.ok()) return thinned.status();
  return *thinned < kMostAtOnce;
}

}  // namespace skinframe::server
