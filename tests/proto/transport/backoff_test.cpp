// SPDX-License-Identifier: Apache-2.0
#include "proto/transport/backoff.h"

#include <gtest/gtest.h>

namespace skinframe::transport {
namespace {

using std::chrono::milliseconds;

TEST(BackoffTest, DoublesUpToItsLongestAndKeepsToItsJitter) {
  Backoff backoff(milliseconds(100), milliseconds(1000), 7);
  for (const int step : {100, 200, 400, 800, 1000, 1000}) {
    const auto delay = backoff.next();
    EXPECT_GE(delay.count(), step / 2);
    EXPECT_LE(delay.count(), step);
  }
  backoff.reset();
  EXPECT_LE(backoff.next().count(), 100);
}

TEST(BackoffTest, CallersThatFailedTogetherDoNotComeBackTogether) {
  Backoff a(milliseconds(1000), milliseconds(1000), 1), b(milliseconds(1000), milliseconds(1000), 2);
  EXPECT_NE(a.next(), b.next());
}

}  // namespace
}  // namespace skinframe::transport
