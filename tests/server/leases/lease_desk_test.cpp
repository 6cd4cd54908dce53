// SPDX-License-Identifier: Apache-2.0
#include "server/leases/lease_desk.h"

#include <gtest/gtest.h>

#include <future>

#include "server/store/sqlite_store.h"
#include "tests/server/fixture/example_job.h"
#include "tests/server/fixture/manual_clock.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

using std::chrono::seconds;
using Answered = std::future<absl::StatusOr<std::optional<JobRecord>>>;

class LeaseDeskTest : public testing::Test, public CommitListener {
 protected:
  void SetUp() override {
    store_ = *open_sqlite_store(folder_.path() / "jobs.sqlite", this);
    desk_.emplace(*store_, executor_, clock_, AttemptPolicy{}, tenants_);
  }
  void TearDown() override {
    desk_->close();
    executor_.stop();
  }
  void committed(const JobRecord& record, bool) override {
    if (desk_ && record.job.state() == v1::JOB_STATE_QUEUED) desk_->job_queued();
  }
  void removed(const std::string&) override {}

  void submit(const std::string& id) {
    ASSERT_TRUE(store_->create(example_job(id, 0, clock_.now()), 100).ok());
  }
  Answered ask(const std::string& worker, Milliseconds wait, LeaseDesk::Ticket* ticket = nullptr) {
    auto promise = std::make_shared<std::promise<absl::StatusOr<std::optional<JobRecord>>>>();
    const auto number =
        desk_->ask(worker, "instance", wait, [promise](auto leased) { promise->set_value(leased); });
    if (ticket != nullptr) *ticket = number;
    return promise->get_future();
  }
  // Waits until the desk has looked for everyone who asked so far: an answer to a further wait of zero proves
  // it, because those before it are asked for first.
  void settle() { EXPECT_FALSE(ask("nobody", Milliseconds(0)).get()->has_value()); }

  TemporaryFolder folder_;
  ManualClock clock_;
  Executor executor_{4};
  const TenantDirectory tenants_;
  std::unique_ptr<JobStore> store_;
  std::optional<LeaseDesk> desk_;
};

TEST_F(LeaseDeskTest, AQueuedJobIsGivenAtOnce) {
  submit("a");
  const auto answer = ask("w", seconds(0)).get();
  ASSERT_TRUE(answer.ok() && answer->has_value());
  EXPECT_EQ((*answer)->lease.worker_id, "w");
}

TEST_F(LeaseDeskTest, AWaitOfZeroWithoutAJobEndsAtOnceWithNothing) {
  const auto answer = ask("w", seconds(0)).get();
  ASSERT_TRUE(answer.ok());
  EXPECT_FALSE(answer->has_value());
}

TEST_F(LeaseDeskTest, WaitingWorkersGetNewJobsInTheOrderOfTheirAsking) {
  auto first = ask("first", seconds(10));
  auto second = ask("second", seconds(10));
  submit("a");
  EXPECT_EQ((*first.get())->job.job_id(), "a");
  submit("b");
  EXPECT_EQ((*second.get())->job.job_id(), "b");
}

// The worker's look into the store and the job's commit meet in every order.
TEST_F(LeaseDeskTest, NoJobIsOverlookedBetweenTheLookAndTheWait) {
  for (int round = 0; round < 500; ++round) {
    auto waiting = ask("w", seconds(10));
    submit("job-" + std::to_string(round));
    ASSERT_EQ(waiting.wait_for(seconds(10)), std::future_status::ready) << round;
    ASSERT_TRUE(waiting.get()->has_value());
  }
}

TEST_F(LeaseDeskTest, AWaitEndsWhenItsTimeIsOver) {
  auto waiting = ask("w", seconds(10));
  clock_.advance(seconds(10) - Milliseconds(1));
  settle();
  EXPECT_EQ(waiting.wait_for(seconds(0)), std::future_status::timeout);
  clock_.advance(Milliseconds(1));
  settle();
  EXPECT_FALSE(waiting.get()->has_value());
}

TEST_F(LeaseDeskTest, NoWaitIsLongerThanItsBound) {
  auto waiting = ask("w", seconds(1'000'000));
  clock_.advance(AttemptPolicy{}.longest_wait);
  settle();
  EXPECT_FALSE(waiting.get()->has_value());
}

TEST_F(LeaseDeskTest, AWorkerThatHungUpGetsNoJob) {
  LeaseDesk::Ticket ticket = 0;
  auto gone = ask("gone", seconds(10), &ticket);
  settle();
  desk_->withdraw(ticket);
  EXPECT_TRUE(absl::IsCancelled(gone.get().status()));
  submit("a");
  EXPECT_EQ((*ask("alive", seconds(10)).get())->lease.worker_id, "alive");
}

// The worker hangs up while the store is being asked for it, or right after the answer.
TEST_F(LeaseDeskTest, AJobThatDidNotReachItsWorkerIsQueuedAgainAtOnceAndNoAttemptIsLost) {
  for (int round = 0; round < 200; ++round) {
    LeaseDesk::Ticket ticket = 0;
    const std::string id = "job-" + std::to_string(round);
    auto gone = ask("gone", seconds(10), &ticket);
    submit(id);
    desk_->withdraw(ticket);
    const auto answer = gone.get();
    if (answer.ok()) desk_->undelivered(**answer);
    const auto next = ask("alive", seconds(10)).get();
    ASSERT_TRUE(next.ok() && next->has_value());
    EXPECT_EQ((*next)->job.job_id(), id);
    EXPECT_EQ((*next)->lost_attempts, 0);
  }
}

TEST_F(LeaseDeskTest, AJobWhoseBackoffPassedIsFoundByTheDuty) {
  submit("a");
  const auto first = ask("w", seconds(0)).get();
  ASSERT_TRUE(first.ok() && first->has_value());
  auto crash = completion("a", (*first)->lease.fencing_token, v1::JOB_STATE_FAILED, v1::REASON_CRASHED);
  crash.set_retryable(true);
  ASSERT_TRUE(store_
                  ->modify("a",
                           [&](const JobRecord& r) {
                             return decide_complete(r, crash, clock_.now(), AttemptPolicy{});
                           })
                  .ok());
  auto waiting = ask("w", seconds(30));
  settle();
  clock_.advance(AttemptPolicy{}.first_backoff);
  ASSERT_TRUE(desk_->run_once(clock_.now()).ok());
  EXPECT_EQ((*waiting.get())->job.attempt(), 2);
}

TEST_F(LeaseDeskTest, ClosingEndsAllWaitsAndRefusesNewOnes) {
  auto waiting = ask("w", seconds(10));
  desk_->close();
  EXPECT_TRUE(absl::IsUnavailable(waiting.get().status()));
  EXPECT_TRUE(absl::IsUnavailable(ask("w", seconds(10)).get().status()));
}

}  // namespace
}  // namespace skinframe::server
