// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/attempt_policy.h"

#include <gtest/gtest.h>

#include <string>

namespace skinframe::server {
namespace {

TEST(AttemptPolicy, DefaultsAreValid) { EXPECT_TRUE(AttemptPolicy{}.validate().ok()); }

TEST(AttemptPolicy, ValidateNamesTheOptionThatIsOutOfRange) {
  AttemptPolicy lease;
  lease.lease = Milliseconds(999);
  EXPECT_NE(lease.validate().message().find("lease"), std::string::npos);
  AttemptPolicy heartbeat;
  heartbeat.heartbeat = heartbeat.lease / 2 + Milliseconds(1);
  EXPECT_NE(heartbeat.validate().message().find("heartbeat"), std::string::npos);
  AttemptPolicy attempts;
  attempts.max_attempts = 0;
  EXPECT_NE(attempts.validate().message().find("max-attempts"), std::string::npos);
}

TEST(Rank, APointOfPriorityWeighsAsMuchAsItsAgeing) {
  const AttemptPolicy policy;
  const Time noon(Milliseconds(1'700'000'000'000));
  const auto rank = [&](Milliseconds after, int priority) { return rank_ms(noon + after, priority, policy); };
  EXPECT_LT(rank(Milliseconds(0), 1), rank(Milliseconds(0), 0));
  EXPECT_LT(rank(Milliseconds(0), 0), rank(Milliseconds(1), 0));
  EXPECT_EQ(rank(Milliseconds(0), 3), rank(2 * policy.ageing, 5));
  // The lowest is overtaken by the highest for 200 points' time, and no longer.
  EXPECT_GT(rank(Milliseconds(0), -100), rank(200 * policy.ageing - Milliseconds(1), 100));
  EXPECT_LT(rank(Milliseconds(0), -100), rank(200 * policy.ageing + Milliseconds(1), 100));
}

TEST(Backoff, DoublesUpToItsBoundAndIsJitteredInTheUpperHalf) {
  const AttemptPolicy policy;  // 1 s, 2 s, 4 s ... 60 s
  EXPECT_EQ(backoff_after(1, 0.0, policy), Milliseconds(500));
  EXPECT_EQ(backoff_after(1, 0.5, policy), Milliseconds(750));
  EXPECT_EQ(backoff_after(2, 0.0, policy), Milliseconds(1000));
  EXPECT_EQ(backoff_after(3, 0.0, policy), Milliseconds(2000));
  EXPECT_EQ(backoff_after(100, 0.0, policy), Milliseconds(30'000));
  for (int n = 1; n < 100; ++n) EXPECT_LT(backoff_after(n, 0.999999, policy), policy.max_backoff);
}

TEST(Backoff, JitterSpreadsOverJobsAndIsTheSameAgain) {
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const double jitter = jitter_of("job-" + std::to_string(i), 1);
    EXPECT_GE(jitter, 0.0);
    EXPECT_LT(jitter, 1.0);
    EXPECT_EQ(jitter, jitter_of("job-" + std::to_string(i), 1));
    sum += jitter;
  }
  EXPECT_NEAR(sum / 1000, 0.5, 0.05);
}

}  // namespace
}  // namespace skinframe::server
