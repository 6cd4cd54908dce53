// SPDX-License-Identifier: Apache-2.0
#include "server/events/event_pages.h"

#include <gtest/gtest.h>

namespace skinframe::server {
namespace {

struct Nobody final : Watcher {
  void wake() override {}
  void server_stops() override {}
};

class EventPagesTest : public testing::Test {
 protected:
  EventPagesTest() { EXPECT_TRUE(hub_.subscribe(job_, watcher_).ok()); }

  absl::StatusOr<std::vector<v1::JobEvent>> read(std::int64_t after_sequence, int limit) {
    ++reads_;
    if (gone_) return absl::NotFoundError("no such job");
    std::vector<v1::JobEvent> events;
    for (std::int64_t i = after_sequence + 1; i <= written_ && static_cast<int>(events.size()) < limit; ++i)
      events.emplace_back().set_sequence(i);
    if (commits_while_read_) write();
    return events;
  }
  void write() {
    ++written_;
    hub_.wake(job_);
  }
  std::size_t count_after(std::int64_t sequence) { return pages_.after(job_, sequence)->events->size(); }

  const std::string job_ = "a";
  const std::string other_ = "b";
  WatchHub hub_{10};
  std::shared_ptr<Nobody> watcher_ = std::make_shared<Nobody>();
  EventPages pages_{hub_, [this](const std::string&, std::int64_t after_sequence, int limit) {
                      return read(after_sequence, limit);
                    }};
  std::int64_t written_ = 3;
  bool commits_while_read_ = false;
  bool gone_ = false;
  int reads_ = 0;
};

TEST_F(EventPagesTest, ManyAtOnePlaceReadTheStoreOnceUntilThereIsNews) {
  for (int i = 0; i < 100; ++i) EXPECT_EQ(count_after(1), 2u);
  EXPECT_EQ(reads_, 1);
  write();
  for (int i = 0; i < 100; ++i) EXPECT_EQ(count_after(1), 3u);
  EXPECT_EQ(reads_, 2);
}

TEST_F(EventPagesTest, ThatThereIsNothingYetIsAlsoReadOnce) {
  for (int i = 0; i < 100; ++i) {
    const auto page = pages_.after(job_, 3);
    EXPECT_TRUE(page->events->empty() && page->to_the_end);
  }
  EXPECT_EQ(reads_, 1);
  write();
  EXPECT_EQ(count_after(3), 1u);
}

TEST_F(EventPagesTest, WhatIsCommittedDuringTheReadIsNeverHidden) {
  commits_while_read_ = true;
  EXPECT_EQ(count_after(0), 3u);
  commits_while_read_ = false;
  EXPECT_EQ(count_after(0), 4u);
}

TEST_F(EventPagesTest, AFullPageIsReadOnceWhateverComesBehindIt) {
  written_ = 1000;
  const auto page = pages_.after(job_, 0);
  EXPECT_EQ(page->events->size(), static_cast<std::size_t>(EventPages::kPage));
  EXPECT_FALSE(page->to_the_end);
  write();
  EXPECT_TRUE(pages_.after(job_, 0)->events == page->events);
  EXPECT_EQ(reads_, 1);
}

TEST_F(EventPagesTest, NothingIsKeptOfAJobThatNobodyWatches) {
  EXPECT_EQ(count_after(0), 3u);
  hub_.unsubscribe(job_, watcher_.get());
  written_ = 4;  // and nobody was there to be woken
  ASSERT_TRUE(hub_.subscribe(job_, watcher_).ok());
  EXPECT_EQ(count_after(0), 4u);
}

TEST_F(EventPagesTest, WhatTheStoreRefusesIsRefusedAndAskedAgain) {
  gone_ = true;
  EXPECT_TRUE(absl::IsNotFound(pages_.after(job_, 0).status()));
  gone_ = false;
  EXPECT_EQ(count_after(0), 3u);
}

TEST_F(EventPagesTest, PagesOfMoreJobsThanAreKeptAreReadAgain) {
  written_ = 3;
  EXPECT_EQ(count_after(0), 3u);
  for (int i = 1; i <= 200; ++i)
    EXPECT_EQ(pages_.after(other_, i)->events->size(), i < 3 ? 3u - static_cast<unsigned>(i) : 0u);
  EXPECT_EQ(count_after(0), 3u);
  EXPECT_EQ(reads_, 202);
}

}  // namespace
}  // namespace skinframe::server
