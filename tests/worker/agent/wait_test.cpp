// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/wait.h"

#include <gtest/gtest.h>

namespace skinframe::agent {
namespace {

TEST(WaitUnlessStopped, EndsAtOnceWhenToldToStop) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(wait_unless_stopped(stop.get_token(), std::chrono::hours(1)));
}

}  // namespace
}  // namespace skinframe::agent
