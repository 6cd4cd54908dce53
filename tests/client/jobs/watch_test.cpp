// SPDX-License-Identifier: Apache-2.0
#include "client/jobs/watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/client/fake/fake_server.h"

namespace skinframe::client {
namespace {

class WatchJob : public fake::FakeServer {
 protected:
  void SetUp() override {
    FakeServer::SetUp();
    jobs_.job.set_job_id("j1");
    jobs_.add_state(v1::JOB_STATE_QUEUED);
    jobs_.add_state(v1::JOB_STATE_RUNNING);
    for (int i = 1; i <= 5; ++i) jobs_.add_progress("size", i);
    jobs_.add_state(v1::JOB_STATE_SUCCEEDED);
  }
  Done watch(WatchOptions options = {}) {
    return watch_job(connection_, "j1", options, [&](const v1::JobEvent& event) {
      seen_.push_back(event.sequence());
      return true;
    });
  }
  std::vector<std::int64_t> seen_;
};

TEST_F(WatchJob, SeesEveryEventInOrderAndEndsWithTheFinalState) {
  ASSERT_TRUE(watch().ok());
  EXPECT_THAT(seen_, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
}

TEST_F(WatchJob, ABrokenStreamIsResumedWithoutGapOrRepetition) {
  jobs_.break_after = {3, 0, 0, 2};
  ASSERT_TRUE(watch().ok());
  EXPECT_THAT(seen_, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(jobs_.watched_from, testing::ElementsAre(0, 3, 3, 3, 5));
}

TEST_F(WatchJob, AStreamThatAStoppingServerCancelsIsResumedAsWell) {
  jobs_.break_with = grpc::StatusCode::CANCELLED;
  jobs_.break_after = {3};
  ASSERT_TRUE(watch().ok());
  EXPECT_THAT(seen_, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
}

TEST_F(WatchJob, StartsAfterTheGivenSequenceNumber) {
  WatchOptions options;
  options.after_sequence = 6;
  ASSERT_TRUE(watch(options).ok());
  EXPECT_THAT(seen_, testing::ElementsAre(7, 8));
}

TEST_F(WatchJob, AfterTheLastEventOfAnEndedJobThereIsNothingToWaitFor) {
  WatchOptions options;
  options.after_sequence = 8;
  ASSERT_TRUE(watch(options).ok());
  EXPECT_THAT(seen_, testing::IsEmpty());
}

TEST_F(WatchJob, AGapIsAFailureNotASilence) {
  jobs_.events.erase(jobs_.events.begin() + 3);
  const auto watched = watch();
  ASSERT_FALSE(watched.ok());
  EXPECT_EQ(watched.failure().kind, FailureKind::kInternal);
  EXPECT_THAT(seen_, testing::ElementsAre(1, 2, 3));
}

TEST_F(WatchJob, ThinnedEventsAreToldOfAndTheWatchGoesOnBehindThem) {
  jobs_.tell_of_gaps = true;
  jobs_.events.erase(jobs_.events.begin() + 2, jobs_.events.begin() + 7);
  std::vector<std::int64_t> gone;
  WatchOptions options;
  options.on_thinned = [&](std::int64_t first, std::int64_t last) { gone = {first, last}; };
  ASSERT_TRUE(watch(options).ok());
  EXPECT_THAT(seen_, testing::ElementsAre(1, 2, 8));
  EXPECT_THAT(gone, testing::ElementsAre(3, 7));
  EXPECT_THAT(clock_.waits, testing::IsEmpty());
}

TEST_F(WatchJob, TheHandlerMayHaveEnough) {
  const auto watched = watch_job(connection_, "j1", {}, [&](const v1::JobEvent& event) {
    seen_.push_back(event.sequence());
    return event.sequence() < 3;
  });
  ASSERT_TRUE(watched.ok());
  EXPECT_THAT(seen_, testing::ElementsAre(1, 2, 3));
}

TEST_F(WatchJob, PatienceEndsWhenTheServerStaysAway) {
  jobs_.break_after.assign(1000, 0);
  int lost = 0;
  WatchOptions options;
  options.patience = std::chrono::seconds(60);
  options.on_lost = [&] { ++lost; };
  const auto watched = watch(options);
  ASSERT_FALSE(watched.ok());
  EXPECT_EQ(watched.failure().kind, FailureKind::kUnreachable);
  EXPECT_EQ(lost, 1);
  EXPECT_GT(clock_.waits.size(), 20u);
}

TEST_F(WatchJob, ARequestToStopIsAnInterruption) {
  std::stop_source stop;
  const Connection connection = connection_.with_stop(stop.get_token());
  jobs_.break_after = {2};
  const auto watched = watch_job(connection, "j1", {}, [&](const v1::JobEvent& event) {
    if (event.sequence() == 2) stop.request_stop();
    return true;
  });
  ASSERT_FALSE(watched.ok());
  EXPECT_EQ(watched.failure().kind, FailureKind::kInterrupted);
}

}  // namespace
}  // namespace skinframe::client
