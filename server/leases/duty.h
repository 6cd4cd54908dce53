// SPDX-License-Identifier: Apache-2.0
// Something the server does again and again by itself. One duty a file; run_once is all of it, so a test
// turns the clock and calls it.
#pragma once

#include <string_view>

#include "absl/status/status.h"
#include "server/jobs/clock.h"

namespace skinframe::server {

class Duty {
 public:
  virtual ~Duty() = default;
  virtual std::string_view name() const = 0;
  virtual absl::Status run_once(Time now) = 0;  // an error is logged, and the next round tries again
};

}  // namespace skinframe::server
