// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/backoff.h"

#include <gtest/gtest.h>

namespace skinframe::agent {
namespace {

using std::chrono::milliseconds;

TEST(AgentBackoff, DoublesUpToItsLongestAndKeepsToItsJitter) {
  Backoff backoff(milliseconds(100), milliseconds(1000), 7);
  for (const int step : {100, 200, 400, 800, 1000, 1000}) {
    const auto delay = backoff.next();
    EXPECT_GE(delay.count(), step / 2);
    EXPECT_LE(delay.count(), step);
  }
  backoff.reset();
  EXPECT_LE(backoff.next().count(), 100);
}

TEST(AgentBackoff, WorkersThatFailedTogetherDoNotComeBackTogether) {
  Backoff a(milliseconds(1000), milliseconds(1000), 1), b(milliseconds(1000), milliseconds(1000), 2);
  EXPECT_NE(a.next(), b.next());
}

TEST(AgentBackoff, AWaitEndsAtOnceWhenToldToStop) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(wait_unless_stopped(stop.get_token(), std::chrono::hours(1)));
}

}  // namespace
}  // namespace skinframe::agent
