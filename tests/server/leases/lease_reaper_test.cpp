// SPDX-License-Identifier: Apache-2.0
// Silence, takeover and the late worker, with a clock that the test turns.
#include "server/leases/lease_reaper.h"

#include <gtest/gtest.h>

#include "server/leases/deadline_watch.h"
#include "server/store/sqlite_database.h"
#include "server/store/sqlite_store.h"
#include "tests/server/fixture/example_job.h"
#include "tests/server/fixture/manual_clock.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

class Leases : public testing::Test {
 protected:
  void SetUp() override {
    store_ = *open_sqlite_store(folder_.path() / "jobs.sqlite", nullptr);
    reaper_.emplace(*store_, policy_, clock_.now() - policy_.lease);  // a server that has been up for a while
  }
  void submit(JobRecord record) {
    ASSERT_TRUE(store_->create(decide_submit(record, clock_.now(), policy_), 100).ok());
  }
  std::int64_t lease() {
    const auto job = store_->lease_next(clock_.now(), [&](const JobRecord& record, std::int64_t token) {
      return leased(record, token, clock_.now(), policy_);
    });
    EXPECT_TRUE(job.ok() && job->has_value());
    return job.ok() && job->has_value() ? (*job)->lease.fencing_token : 0;
  }
  absl::Status beat(std::int64_t token) {
    return store_
        ->modify("job",
                 [&](const JobRecord& r) {
                   return decide_heartbeat(r, heartbeat("job", token), clock_.now(), policy_);
                 })
        .status();
  }
  absl::Status complete(std::int64_t token, v1::JobState state, const std::string& detail = "") {
    auto request = completion("job", token, state);
    request.set_detail(detail);
    return store_
        ->modify("job",
                 [&](const JobRecord& r) { return decide_complete(r, request, clock_.now(), policy_); })
        .status();
  }
  void reap() { ASSERT_TRUE(reaper_->run_once(clock_.now()).ok()); }
  v1::Job job() { return store_->get("job")->job; }

  const AttemptPolicy policy_;
  ManualClock clock_;
  TemporaryFolder folder_;
  std::unique_ptr<JobStore> store_;
  std::optional<LeaseReaper> reaper_;
};

TEST_F(Leases, AJobWithHeartbeatsStaysWithItsWorker) {
  submit(example_record("job"));
  const auto token = lease();
  for (int i = 0; i < 10; ++i) {
    clock_.advance(policy_.lease - Milliseconds(1));
    reap();
    ASSERT_TRUE(beat(token).ok()) << i;
  }
  EXPECT_EQ(job().state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(job().attempt(), 1);
}

TEST_F(Leases, LateWorkerCannotOverwriteARescuedJob) {
  submit(example_record("job"));
  const auto late = lease();
  clock_.advance(policy_.lease);
  reap();
  EXPECT_EQ(job().state(), v1::JOB_STATE_QUEUED);
  EXPECT_TRUE(absl::IsAborted(complete(late, v1::JOB_STATE_SUCCEEDED, "late")));  // while it is queued

  clock_.advance(policy_.max_backoff);
  const auto rescuer = lease();
  EXPECT_TRUE(absl::IsAborted(beat(late)));
  EXPECT_TRUE(absl::IsAborted(complete(late, v1::JOB_STATE_SUCCEEDED, "late")));  // while it runs elsewhere
  ASSERT_TRUE(complete(rescuer, v1::JOB_STATE_SUCCEEDED, "rescued").ok());
  EXPECT_TRUE(absl::IsAborted(complete(late, v1::JOB_STATE_SUCCEEDED, "late")));  // after its end
  EXPECT_EQ(job().state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job().detail(), "rescued");
  EXPECT_EQ(job().attempt(), 2);
}

TEST_F(Leases, AWorkerThatIsLateButNotYetReplacedMayGoOn) {
  submit(example_record("job"));
  const auto token = lease();
  clock_.advance(policy_.lease * 2);
  EXPECT_TRUE(beat(token).ok());
  reap();
  EXPECT_EQ(job().state(), v1::JOB_STATE_RUNNING);
}

TEST_F(Leases, AJobThatKillsItsWorkersFailsInsteadOfLooping) {
  submit(example_record("job"));
  for (int attempt = 1; attempt <= policy_.max_attempts; ++attempt) {
    lease();
    clock_.advance(policy_.lease);
    reap();
    clock_.advance(policy_.max_backoff);
  }
  EXPECT_EQ(job().state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job().reason(), v1::REASON_CRASHED);
  EXPECT_EQ(job().attempt(), policy_.max_attempts);
}

TEST_F(Leases, AJobWhoseRowIsDamagedDoesNotHoldUpTheOthers) {
  for (const char* id : {"damaged", "job"}) submit(example_record(id));
  lease();
  lease();
  JobRecord late = example_record("late");
  late.job.mutable_spec()->mutable_deadline()->set_seconds(1);
  for (const char* id : {"damaged too", "late"}) {
    late.job.set_job_id(id);
    submit(late);
  }
  const auto database =
      *SqliteDatabase::open(folder_.path() / "jobs.sqlite", SqliteDatabase::Mode::kReadWrite);
  ASSERT_TRUE(database->execute("UPDATE jobs SET spec = x'ff' WHERE job_id LIKE 'damaged%'").ok());
  clock_.advance(policy_.lease);
  reap();
  EXPECT_EQ(job().state(), v1::JOB_STATE_QUEUED);
  DeadlineWatch deadlines(*store_);
  ASSERT_TRUE(deadlines.run_once(clock_.now()).ok());
  EXPECT_EQ(store_->get("late")->job.state(), v1::JOB_STATE_FAILED);
}

TEST_F(Leases, AfterARestartOfTheServerWorkersGetOneLeaseTimeToReport) {
  submit(example_record("job"));
  const auto token = lease();
  clock_.advance(policy_.lease * 5);  // the server was away
  store_.reset();
  store_ = *open_sqlite_store(folder_.path() / "jobs.sqlite", nullptr);
  reaper_.emplace(*store_, policy_, clock_.now());
  reap();
  EXPECT_EQ(job().state(), v1::JOB_STATE_RUNNING);
  ASSERT_TRUE(beat(token).ok());
  clock_.advance(policy_.lease - Milliseconds(1));
  reap();
  EXPECT_EQ(job().state(), v1::JOB_STATE_RUNNING);
  clock_.advance(Milliseconds(1));
  reap();
  EXPECT_EQ(job().state(), v1::JOB_STATE_QUEUED);
}

TEST_F(Leases, AWorkerThatIgnoresCancellationLosesTheJobWithItsLease) {
  submit(example_record("job"));
  const auto token = lease();
  ASSERT_TRUE(
      store_->modify("job", [&](const JobRecord& r) { return decide_cancel(r, clock_.now(), policy_); })
          .ok());
  for (Milliseconds passed{0}; passed < policy_.lease; passed += policy_.heartbeat) {
    ASSERT_TRUE(beat(token).ok());
    clock_.advance(policy_.heartbeat);
  }
  reap();
  EXPECT_EQ(job().state(), v1::JOB_STATE_CANCELLED);
  EXPECT_TRUE(absl::IsAborted(beat(token)));
}

TEST_F(Leases, AQueuedJobPastItsDeadlineIsTimedOut) {
  JobRecord record = example_record("job");
  record.job.mutable_spec()->mutable_deadline()->set_seconds(5);
  submit(record);
  DeadlineWatch deadlines(*store_);
  clock_.advance(Milliseconds(4'999));
  ASSERT_TRUE(deadlines.run_once(clock_.now()).ok());
  EXPECT_EQ(job().state(), v1::JOB_STATE_QUEUED);
  clock_.advance(Milliseconds(1));
  ASSERT_TRUE(deadlines.run_once(clock_.now()).ok());
  EXPECT_EQ(job().state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job().reason(), v1::REASON_TIMED_OUT);
}

}  // namespace
}  // namespace skinframe::server
