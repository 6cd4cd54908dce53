// SPDX-License-Identifier: Apache-2.0
// Counts what becomes of jobs at this server: each change of state that was committed through it. From any
// thread.
#pragma once

#include <prometheus/counter.h>
#include <prometheus/registry.h>

#include "skinframe/v1/job.pb.h"

namespace skinframe::server {

class JobCounts {
 public:
  explicit JobCounts(prometheus::Registry& registry);

  void state_changed(const v1::Job& job);

 private:
  prometheus::Counter& submitted_;
  prometheus::Counter& attempts_;
  prometheus::Counter& requeued_;
  prometheus::Family<prometheus::Counter>& ended_;
};

}  // namespace skinframe::server
