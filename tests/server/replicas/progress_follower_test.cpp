// SPDX-License-Identifier: Apache-2.0
#include "server/replicas/progress_follower.h"

#include <gtest/gtest.h>

#include "server/store/sqlite_store.h"
#include "tests/server/fixture/example_job.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

constexpr Milliseconds kEvery{500};

struct Sleeper final : Watcher {
  int wakes = 0;
  void wake() override { ++wakes; }
  void server_stops() override {}
};

class ProgressFollowerTest : public testing::Test {
 protected:
  ProgressFollowerTest() : store_(*open_sqlite_store(folder_.path() / "jobs.sqlite", nullptr)) {
    EXPECT_TRUE(store_->create(example_job("a"), 10).ok());
    EXPECT_TRUE(store_->create(example_job("b"), 10).ok());
    EXPECT_TRUE(hub_.subscribe("a", a_).ok());
    EXPECT_TRUE(hub_.subscribe("b", b_).ok());
  }
  // An event of a that this server's hub is not told of: as if another server had written it.
  void write_elsewhere() {
    ASSERT_TRUE(store_
                    ->lease_next(kNoon, [](const JobRecord& job,
                                           std::int64_t token) { return leased(job, token, kNoon); })
                    .ok());
  }

  TemporaryFolder folder_;
  WatchHub hub_{10};
  std::unique_ptr<JobStore> store_;
  std::shared_ptr<Sleeper> a_ = std::make_shared<Sleeper>();
  std::shared_ptr<Sleeper> b_ = std::make_shared<Sleeper>();
  ProgressFollower follower_{*store_, hub_, kEvery};
};

TEST_F(ProgressFollowerTest, WakesTheWatchersOfJobsThatHaveNewsAndNobodyElse) {
  ASSERT_TRUE(follower_.run_once(kNoon).ok());  // learns where the jobs stand
  const int a = a_->wakes;
  const int b = b_->wakes;
  write_elsewhere();
  ASSERT_TRUE(follower_.run_once(kNoon + kEvery).ok());
  EXPECT_EQ(a_->wakes, a + 1);
  EXPECT_EQ(b_->wakes, b);
}

TEST_F(ProgressFollowerTest, LooksNoMoreOftenThanItShall) {
  ASSERT_TRUE(follower_.run_once(kNoon).ok());
  write_elsewhere();
  const int before = a_->wakes;
  ASSERT_TRUE(follower_.run_once(kNoon + kEvery - Milliseconds(1)).ok());
  EXPECT_EQ(a_->wakes, before);
}

TEST_F(ProgressFollowerTest, GoesOnWhenTheClockWasSetBack) {
  ASSERT_TRUE(follower_.run_once(kNoon).ok());
  write_elsewhere();
  const int before = a_->wakes;
  ASSERT_TRUE(follower_.run_once(kNoon - Milliseconds(3'600'000)).ok());
  EXPECT_EQ(a_->wakes, before + 1);
}

}  // namespace
}  // namespace skinframe::server
