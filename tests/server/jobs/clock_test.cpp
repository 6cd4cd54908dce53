// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/clock.h"

#include <gtest/gtest.h>

#include <set>

#include "server/jobs/job_id.h"

namespace skinframe::server {
namespace {

TEST(Clock, TimestampsKeepMillisecondsBeforeAndAfter1970) {
  for (const std::int64_t ms : {0LL, 1LL, 999LL, 1'700'000'000'123LL, -1LL, -1500LL}) {
    const Time time{Milliseconds(ms)};
    EXPECT_EQ(from_timestamp(to_timestamp(time)), time) << ms;
    EXPECT_GE(to_timestamp(time).nanos(), 0) << ms;
  }
}

TEST(Clock, DurationsKeepMilliseconds) {
  EXPECT_EQ(from_duration(to_duration(Milliseconds(10'500))), Milliseconds(10'500));
  EXPECT_EQ(to_duration(Milliseconds(10'500)).nanos(), 500'000'000);
}

TEST(JobId, Is128RandomBitsInHexadecimal) {
  RandomIds ids;
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = ids.next();
    EXPECT_EQ(id.size(), 32u);
    EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_TRUE(seen.insert(id).second);
  }
}

TEST(JobId, Sha256MatchesThePublishedExample) {
  // FIPS 180-2, appendix B.1
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace skinframe::server
