// SPDX-License-Identifier: Apache-2.0
#include "server/events/watch_hub.h"

#include <gtest/gtest.h>

namespace skinframe::server {
namespace {

struct CountingWatcher : Watcher {
  int woken = 0;
  int stopped = 0;
  void wake() override { ++woken; }
  void server_stops() override { ++stopped; }
};

TEST(WatchHub, WakesTheWatchersOfTheJobAndNoOthers) {
  WatchHub hub(10);
  const auto first = std::make_shared<CountingWatcher>();
  const auto second = std::make_shared<CountingWatcher>();
  const auto other = std::make_shared<CountingWatcher>();
  ASSERT_TRUE(hub.subscribe("a", first).ok());
  ASSERT_TRUE(hub.subscribe("a", second).ok());
  ASSERT_TRUE(hub.subscribe("b", other).ok());
  hub.wake("a");
  hub.wake("unwatched");
  EXPECT_EQ(first->woken, 1);
  EXPECT_EQ(second->woken, 1);
  EXPECT_EQ(other->woken, 0);
}

TEST(WatchHub, AWatcherThatLeftIsNotWokenAndNotKept) {
  WatchHub hub(10);
  const auto watcher = std::make_shared<CountingWatcher>();
  ASSERT_TRUE(hub.subscribe("a", watcher).ok());
  hub.unsubscribe("a", watcher.get());
  hub.unsubscribe("a", watcher.get());
  hub.wake("a");
  EXPECT_EQ(watcher->woken, 0);
  EXPECT_EQ(hub.watchers(), 0u);
  EXPECT_EQ(watcher.use_count(), 1);
}

TEST(WatchHub, IsBoundedAndAFreedPlaceIsGivenAgain) {
  WatchHub hub(1);
  const auto first = std::make_shared<CountingWatcher>();
  const auto second = std::make_shared<CountingWatcher>();
  ASSERT_TRUE(hub.subscribe("a", first).ok());
  EXPECT_TRUE(absl::IsResourceExhausted(hub.subscribe("b", second)));
  hub.unsubscribe("a", first.get());
  EXPECT_TRUE(hub.subscribe("b", second).ok());
}

TEST(WatchHub, ClosingTellsEveryoneOnceAndTakesNobodyMore) {
  WatchHub hub(10);
  const auto watcher = std::make_shared<CountingWatcher>();
  ASSERT_TRUE(hub.subscribe("a", watcher).ok());
  hub.close();
  EXPECT_EQ(watcher->stopped, 1);
  EXPECT_TRUE(absl::IsUnavailable(hub.subscribe("a", std::make_shared<CountingWatcher>())));
}

// A watcher may leave while it is being woken: wakes happen outside the hub's lock.
TEST(WatchHub, AWatcherMayLeaveFromWithinItsWake) {
  struct Leaver : Watcher {
    WatchHub* hub = nullptr;
    void wake() override { hub->unsubscribe("a", this); }
    void server_stops() override {}
  };
  WatchHub hub(10);
  const auto leaver = std::make_shared<Leaver>();
  leaver->hub = &hub;
  ASSERT_TRUE(hub.subscribe("a", leaver).ok());
  hub.wake("a");
  EXPECT_EQ(hub.watchers(), 0u);
}

}  // namespace
}  // namespace skinframe::server
