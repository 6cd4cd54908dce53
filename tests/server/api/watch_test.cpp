// SPDX-License-Identifier: Apache-2.0
// WatchJob: all events, in order, once, from any position, to any number of watchers.
#include <future>
#include <latch>
#include <memory>
#include <thread>

#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

using WatchTest = ApiTest;

void expect_gap_free(const std::vector<v1::JobEvent>& events, std::int64_t first, std::int64_t last) {
  ASSERT_EQ(static_cast<std::int64_t>(events.size()), last - first + 1);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].sequence(), first + static_cast<std::int64_t>(i));
  }
}

TEST_F(WatchTest, WatchersFromEveryPositionSeeTheSameEventsWhileTheyHappen) {
  const std::string id = submit();
  std::vector<std::future<std::vector<v1::JobEvent>>> watchers;
  for (int i = 0; i < 8; ++i) {
    watchers.push_back(std::async(std::launch::async, [&] {
      std::vector<v1::JobEvent> events;
      EXPECT_TRUE(watch(id, 0, &events).ok());
      return events;
    }));
  }
  const v1::Assignment assignment = lease();
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(beat(assignment, nullptr, 10).ok());
  ASSERT_TRUE(complete(outcome(assignment, v1::JOB_STATE_SUCCEEDED)).ok());
  const std::int64_t last = 2 + 200 + 1;

  std::vector<std::string> whole;
  for (auto& watcher : watchers) {
    const auto events = watcher.get();
    expect_gap_free(events, 1, last);
    std::vector<std::string> bytes;
    for (const auto& event : events) bytes.push_back(event.SerializeAsString());
    if (whole.empty()) whole = bytes;
    EXPECT_EQ(bytes, whole);
  }
  for (const std::int64_t after : {1LL, 2LL, 63LL, 64LL, 65LL, 202LL}) {
    std::vector<v1::JobEvent> events;
    EXPECT_TRUE(watch(id, after, &events).ok());
    expect_gap_free(events, after + 1, last);
    EXPECT_EQ(events.front().SerializeAsString(), whole[static_cast<std::size_t>(after)]);
  }
}

TEST_F(WatchTest, EndsAtOnceWhenTheFinalEventWasSeenAlready) {
  const std::string id = submit();
  ASSERT_TRUE(cancel(id).ok());
  std::vector<v1::JobEvent> events;
  EXPECT_TRUE(watch(id, 2, &events).ok());
  EXPECT_TRUE(events.empty());
}

// One of very many watchers: no thread of its own.
class CountingWatcher final : public grpc::ClientReadReactor<v1::JobEvent> {
 public:
  CountingWatcher(v1::JobService::Stub& stub, const std::string& job_id, std::latch& began, std::latch& ended)
      : began_(began), ended_(ended) {
    set_deadline(context_);
    request_.set_job_id(job_id);
    stub.async()->WatchJob(&context_, &request_, this);
    StartRead(&event_);
    StartCall();
  }
  void OnReadDone(bool ok) override {
    if (!ok) return;
    if (events_++ == 0) began_.count_down();
    StartRead(&event_);
  }
  void OnDone(const grpc::Status& status) override {
    if (events_ == 0) began_.count_down();  // the test does not hang
    status_ = status;
    ended_.count_down();
  }
  int events() const { return events_; }
  const grpc::Status& status() const { return status_; }

 private:
  grpc::ClientContext context_;
  v1::WatchJobRequest request_;
  v1::JobEvent event_;
  std::latch &began_, &ended_;
  int events_ = 0;
  grpc::Status status_;
};

TEST_F(WatchTest, TwoThousandWatchersFitOnOneChannel) {
  constexpr int kWatchers = 2000;
  const std::string id = submit();
  std::latch began(kWatchers), ended(kWatchers);
  std::vector<std::unique_ptr<CountingWatcher>> watchers;
  for (int i = 0; i < kWatchers; ++i) {
    watchers.push_back(std::make_unique<CountingWatcher>(*jobs_, id, began, ended));
  }
  began.wait();  // all of them at once
  ASSERT_TRUE(cancel(id).ok());
  ended.wait();
  for (const auto& watcher : watchers) {
    ASSERT_TRUE(watcher->status().ok()) << watcher->status().error_message();
    ASSERT_EQ(watcher->events(), 2);
  }
}

TEST_F(WatchTest, APositionBeyondTheLastEventIsOutOfRange) {
  const std::string id = submit();
  std::vector<v1::JobEvent> events;
  EXPECT_EQ(watch(id, 2, &events).error_code(), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_EQ(watch(id, -1, &events).error_code(), grpc::StatusCode::OUT_OF_RANGE);
}

TEST_F(WatchTest, AnUnknownJobIsNotFound) {
  std::vector<v1::JobEvent> events;
  EXPECT_EQ(watch("none", 0, &events).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(WatchTest, AClientThatHangsUpHarmsNobody) {
  const std::string id = submit();
  for (int i = 0; i < 20; ++i) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::WatchJobRequest request;
    request.set_job_id(id);
    const auto reader = jobs_->WatchJob(&context, request);
    v1::JobEvent event;
    ASSERT_TRUE(reader->Read(&event));
    context.TryCancel();
    EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
  }
  ASSERT_TRUE(cancel(id).ok());
  std::vector<v1::JobEvent> events;
  EXPECT_TRUE(watch(id, 0, &events).ok());
  expect_gap_free(events, 1, 2);
}

// It reads one event and then nothing more: its stream fills up, and the others go on.
TEST_F(WatchTest, AWatcherThatDoesNotReadHoldsNobodyUp) {
  const std::string id = submit();
  grpc::ClientContext context;
  set_deadline(context);
  v1::WatchJobRequest request;
  request.set_job_id(id);
  const auto lazy = jobs_->WatchJob(&context, request);
  v1::JobEvent event;
  ASSERT_TRUE(lazy->Read(&event));
  const v1::Assignment assignment = lease();
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(beat(assignment, nullptr, 100).ok());
  ASSERT_TRUE(complete(outcome(assignment, v1::JOB_STATE_SUCCEEDED)).ok());
  std::vector<v1::JobEvent> events;
  EXPECT_TRUE(watch(id, 0, &events).ok());
  expect_gap_free(events, 1, 3003);
  std::int64_t expected = 1;
  while (lazy->Read(&event)) EXPECT_EQ(event.sequence(), ++expected);
  EXPECT_TRUE(lazy->Finish().ok());
  EXPECT_EQ(expected, 3003);
}

TEST_F(WatchTest, AStoppingServerEndsWatchesAsUnavailableAndTheyResume) {
  const std::string id = submit();
  grpc::ClientContext context;
  set_deadline(context);
  v1::WatchJobRequest request;
  request.set_job_id(id);
  const auto reader = jobs_->WatchJob(&context, request);
  v1::JobEvent event;
  ASSERT_TRUE(reader->Read(&event));
  server_->stop();
  EXPECT_FALSE(reader->Read(&event));
  const grpc::Status stopped = reader->Finish();
  EXPECT_EQ(stopped.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_GT(retry_delay(stopped).value_or(Milliseconds(0)), Milliseconds(0));
  restart();
  ASSERT_TRUE(cancel(id).ok());
  std::vector<v1::JobEvent> events;
  EXPECT_TRUE(watch(id, 1, &events).ok());
  expect_gap_free(events, 2, 2);
}

}  // namespace
}  // namespace skinframe::server
