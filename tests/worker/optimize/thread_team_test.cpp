// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/thread_team.h"

#include <gtest/gtest.h>

#include <atomic>

namespace skinframe {
namespace {

TEST(ThreadTeam, EveryTaskIsDoneOnceBeforeRunReturns) {
  for (int threads : {1, 2, 5}) {
    ThreadTeam team(threads);
    EXPECT_EQ(team.size(), threads);
    for (int round = 0; round < 200; ++round) {
      std::vector<std::atomic<int>> done(round % 17);
      team.run(round % 17, [&](int task) { ++done[task]; });
      for (const auto& times : done) ASSERT_EQ(times, 1);
    }
  }
}

}  // namespace
}  // namespace skinframe
