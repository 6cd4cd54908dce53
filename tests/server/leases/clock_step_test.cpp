// SPDX-License-Identifier: Apache-2.0
// The system clock is set while jobs run: it may cost time and attempts, never a job or its result.
#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "server/leases/lease_reaper.h"
#include "server/store/sqlite_store.h"
#include "tests/server/fixture/example_job.h"
#include "tests/server/fixture/manual_clock.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

constexpr Milliseconds kHour{3'600'000};

struct Held {
  std::string job_id;
  std::int64_t token;
};

class ClockSteps : public testing::Test {
 protected:
  void SetUp() override {
    policy_.max_attempts = 100;
    store_ = *open_sqlite_store(folder_.path() / "jobs.sqlite", nullptr);
    reaper_.emplace(*store_, policy_, clock_.now() - policy_.lease);
  }
  void submit(const std::string& job_id) {
    ASSERT_TRUE(
        store_->create(decide_submit(example_record(job_id), clock_.now(), AttemptPolicy{}), 1000).ok());
  }
  std::optional<Held> lease() {
    const auto job = store_->lease_next(clock_.now(), [&](const JobRecord& record, std::int64_t token) {
      return leased(record, token, clock_.now(), policy_);
    });
    EXPECT_TRUE(job.ok()) << job.status();
    if (!job.ok() || !*job) return std::nullopt;
    return Held{(*job)->job.job_id(), (*job)->lease.fencing_token};
  }
  absl::Status beat(const Held& held) {
    return store_
        ->modify(held.job_id,
                 [&](const JobRecord& r) {
                   return decide_heartbeat(r, heartbeat(held.job_id, held.token), clock_.now(), policy_);
                 })
        .status();
  }
  absl::Status complete(const Held& held) {
    const auto request = completion(held.job_id, held.token, v1::JOB_STATE_SUCCEEDED);
    return store_
        ->modify(held.job_id,
                 [&](const JobRecord& r) { return decide_complete(r, request, clock_.now(), policy_); })
        .status();
  }
  void reap() { ASSERT_TRUE(reaper_->run_once(clock_.now()).ok()); }
  v1::JobState state(const std::string& job_id) { return store_->get(job_id)->job.state(); }

  AttemptPolicy policy_;
  ManualClock clock_;
  TemporaryFolder folder_;
  std::unique_ptr<JobStore> store_;
  std::optional<LeaseReaper> reaper_;
};

TEST_F(ClockSteps, SetForwardTheJobIsTakenBackAndTheOldAttemptsResultRefused) {
  submit("job");
  const auto first = lease();
  clock_.advance(kHour);
  reap();
  EXPECT_EQ(state("job"), v1::JOB_STATE_QUEUED);
  EXPECT_TRUE(absl::IsAborted(complete(*first)));
  clock_.advance(policy_.max_backoff);
  const auto second = lease();
  ASSERT_TRUE(second);
  EXPECT_TRUE(absl::IsAborted(beat(*first)));
  EXPECT_TRUE(complete(*second).ok());
}

TEST_F(ClockSteps, SetForwardAWorkerThatIsHeardBeforeTheReaperKeepsItsJob) {
  submit("job");
  const auto held = lease();
  clock_.advance(kHour);
  ASSERT_TRUE(beat(*held).ok());
  reap();
  EXPECT_EQ(state("job"), v1::JOB_STATE_RUNNING);
  EXPECT_TRUE(complete(*held).ok());
}

TEST_F(ClockSteps, SetBackARunningJobStaysWithItsWorkerWhoseHeartbeatsCountFromTheNewTime) {
  submit("job");
  const auto held = lease();
  clock_.advance(-kHour);
  reap();
  EXPECT_EQ(state("job"), v1::JOB_STATE_RUNNING);
  ASSERT_TRUE(beat(*held).ok());
  clock_.advance(policy_.lease);  // and then it falls silent
  reap();
  EXPECT_EQ(state("job"), v1::JOB_STATE_QUEUED) << "the lease counts from the heartbeat, not from before";
}

TEST_F(ClockSteps, SetBackWhatADeadWorkerHeldIsTakenUpOnceTheClockHasCaughtUp) {
  submit("job");
  ASSERT_TRUE(lease());
  clock_.advance(-kHour);
  reap();
  EXPECT_EQ(state("job"), v1::JOB_STATE_RUNNING);
  clock_.advance(kHour + policy_.lease);
  reap();
  EXPECT_EQ(state("job"), v1::JOB_STATE_QUEUED);
}

// Random steps between everything that workers and the reaper do.
TEST_F(ClockSteps, HoweverItIsSetEachJobSucceedsOnceAndNoResultOfAnAttemptThatIsOverIsAccepted) {
  constexpr int kJobs = 40;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::string> ids;
    for (int i = 0; i < kJobs; ++i) submit(ids.emplace_back(std::to_string(seed) + "-" + std::to_string(i)));
    std::deque<Held> workers;  // some of them late
    std::map<std::string, int> accepted;
    const auto one_acts = [&] {
      if (workers.empty()) return;
      const Held held = workers.front();
      workers.pop_front();
      const bool owns = store_->get(held.job_id)->lease.fencing_token == held.token &&
                        state(held.job_id) == v1::JOB_STATE_RUNNING;
      const bool ends = random() % 2 == 0;
      const absl::Status answer = ends ? complete(held) : beat(held);
      EXPECT_EQ(answer.ok(), owns) << answer;
      if (ends && answer.ok()) ++accepted[held.job_id];
      if (!ends && answer.ok()) workers.push_back(held);
    };
    for (int step = 0; step < 400; ++step) {
      switch (random() % 4) {
        case 0:
          clock_.advance(Milliseconds(static_cast<int>(random() % 7'200'000) - 3'600'000));
          break;
        case 1:
          if (const auto held = lease()) workers.push_back(*held);
          break;
        case 2:
          one_acts();
          break;
        case 3:
          reap();
          break;
      }
    }
    // From now on it goes right.
    clock_.advance(kHour * 400);
    while (static_cast<int>(accepted.size()) < kJobs) {
      reap();
      clock_.advance(policy_.max_backoff);
      const auto held = lease();
      ASSERT_TRUE(held) << "a job neither runs, waits nor ended";
      ASSERT_TRUE(complete(*held).ok());
      ++accepted[held->job_id];
    }
    for (const std::string& id : ids) {
      EXPECT_EQ(state(id), v1::JOB_STATE_SUCCEEDED);
      EXPECT_EQ(accepted[id], 1) << id;
    }
  }
}

}  // namespace
}  // namespace skinframe::server
