// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/decisions.h"

#include <gtest/gtest.h>

#include "tests/server/fixture/example_job.h"

namespace skinframe::server {
namespace {

using std::chrono::seconds;

const AttemptPolicy kPolicy;

JobRecord queued() { return example_job("job").record; }
JobRecord running(std::int64_t token = 7) { return leased(queued(), token).record; }

JobRecord after(const Decision& decision) {
  EXPECT_TRUE(decision.ok()) << decision.status();
  EXPECT_TRUE(decision.ok() && decision->has_value());
  return decision.ok() && decision->has_value() ? (*decision)->record : JobRecord();
}

v1::CompleteRequest crash(std::int64_t token = 7) {
  auto request = completion("job", token, v1::JOB_STATE_FAILED, v1::REASON_CRASHED);
  request.set_retryable(true);
  return request;
}

TEST(Submit, QueuesAndTellsSo) {
  const Change change = example_job("job");
  EXPECT_EQ(change.record.job.state(), v1::JOB_STATE_QUEUED);
  ASSERT_EQ(change.events.size(), 1u);
  EXPECT_EQ(change.events[0].state().state(), v1::JOB_STATE_QUEUED);
}

TEST(Cancel, EndsAQueuedJobAtOnce) {
  const JobRecord job = after(decide_cancel(queued(), kNoon, kPolicy));
  EXPECT_EQ(job.job.state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(job.job.reason(), v1::REASON_CANCELLED);
  EXPECT_TRUE(job.job.has_end_time());
}

TEST(Cancel, OnlyAsksARunningJobAndOnlyOnce) {
  const JobRecord job = after(decide_cancel(running(), kNoon, kPolicy));
  EXPECT_EQ(job.job.state(), v1::JOB_STATE_RUNNING);
  EXPECT_TRUE(must_stop(job, kNoon));
  EXPECT_FALSE(decide_cancel(job, kNoon, kPolicy)->has_value());
}

TEST(Cancel, AWorkerThatDoesNotObeyLosesTheJobWithinThePatienceAndNoneGetsMoreTime) {
  const JobRecord asked = after(decide_cancel(running(), kNoon, kPolicy));
  EXPECT_EQ(asked.lease.expires, kNoon + kPolicy.cancel_patience);
  const JobRecord gone = after(decide_lease_expired(asked, kNoon + kPolicy.cancel_patience, kPolicy));
  EXPECT_EQ(gone.job.state(), v1::JOB_STATE_CANCELLED);
  const Time late = kNoon + kPolicy.lease - seconds(1);
  EXPECT_EQ(after(decide_cancel(running(), late, kPolicy)).lease.expires, kNoon + kPolicy.lease);
}

TEST(Cancel, LeavesAnEndedJobAsItIs) {
  const JobRecord done =
      after(decide_complete(running(), completion("job", 7, v1::JOB_STATE_SUCCEEDED), kNoon, kPolicy));
  EXPECT_FALSE(decide_cancel(done, kNoon, kPolicy)->has_value());
}

TEST(Reuse, EndsAtOnceWithTheEarlierResultAndSaysWhose) {
  JobRecord earlier =
      after(decide_complete(running(), completion("job", 7, v1::JOB_STATE_SUCCEEDED), kNoon, kPolicy));
  earlier.job.add_files()->set_path("report.json");
  earlier.job.add_printers()->set_printer_id("p");
  const Change reused = decide_reuse(example_record("second"), earlier, kNoon, kPolicy);
  EXPECT_EQ(reused.record.job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(reused.record.job.reused_job_id(), "job");
  EXPECT_EQ(reused.record.job.files(0).path(), "report.json");
  EXPECT_EQ(reused.record.job.printers_size(), 1);
  EXPECT_TRUE(reused.record.job.has_end_time());
  ASSERT_EQ(reused.events.size(), 1u);
  EXPECT_EQ(reused.events[0].state().state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_NE(reused.events[0].state().detail().find("job job"), std::string::npos);
  const Change third = decide_reuse(example_record("third"), reused.record, kNoon, kPolicy);
  EXPECT_EQ(third.record.job.reused_job_id(), "job") << "the job that was run, not one that reused it";
}

TEST(Undelivered, IsQueuedAgainWithoutLossAndOnlyByItsOwnToken) {
  const JobRecord again = after(decide_undelivered(running(7), 7, kNoon));
  EXPECT_EQ(again.job.state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(again.lost_attempts, 0);
  EXPECT_FALSE(decide_undelivered(running(8), 7, kNoon)->has_value());
  EXPECT_FALSE(decide_undelivered(queued(), 7, kNoon)->has_value());
  const JobRecord asked = after(decide_cancel(running(7), kNoon, kPolicy));
  const JobRecord left = after(decide_undelivered(asked, 7, kNoon));
  EXPECT_EQ(left.job.state(), v1::JOB_STATE_RUNNING) << "a cancelled job is never queued again";
  EXPECT_EQ(after(decide_lease_expired(left, kNoon, kPolicy)).job.state(), v1::JOB_STATE_CANCELLED);
}

TEST(Lease, CountsTheAttemptAndCarriesTheToken) {
  const JobRecord job = running(42);
  EXPECT_EQ(job.job.attempt(), 1);
  EXPECT_EQ(job.lease.fencing_token, 42);
  EXPECT_EQ(job.lease.expires, kNoon + kPolicy.lease);
}

TEST(Heartbeat, ProlongsTheLeaseAndMakesProgressEvents) {
  auto request = heartbeat("job", 7);
  request.add_progress()->set_stage("size");
  request.add_progress()->set_stage("topology");
  const Decision decision = decide_heartbeat(running(), request, kNoon + seconds(3), kPolicy);
  EXPECT_EQ(after(decision).lease.expires, kNoon + seconds(3) + kPolicy.lease);
  ASSERT_EQ((*decision)->events.size(), 2u);
  EXPECT_EQ((*decision)->events[1].progress().stage(), "topology");
  EXPECT_EQ((*decision)->events[1].progress().attempt(), 1);
}

TEST(Heartbeat, OfAStaleTokenIsAborted) {
  EXPECT_TRUE(absl::IsAborted(decide_heartbeat(running(7), heartbeat("job", 6), kNoon, kPolicy).status()));
  EXPECT_TRUE(absl::IsAborted(decide_heartbeat(queued(), heartbeat("job", 0), kNoon, kPolicy).status()));
}

TEST(Heartbeat, DoesNotProlongTheLeaseOfAJobThatShallStop) {
  const JobRecord asked = after(decide_cancel(running(), kNoon, kPolicy));
  auto news = heartbeat("job", 7);
  news.add_progress()->set_stage("size");
  const JobRecord job = after(decide_heartbeat(asked, news, kNoon + seconds(5), kPolicy));
  EXPECT_EQ(job.lease.expires, asked.lease.expires);
  EXPECT_FALSE(decide_heartbeat(asked, heartbeat("job", 7), kNoon + seconds(5), kPolicy)->has_value());
}

TEST(Heartbeat, WithoutNewsChangesNothingUntilAnIntervalHasPassed) {
  const auto question = heartbeat("job", 7);
  EXPECT_FALSE(decide_heartbeat(running(), question, kNoon, kPolicy)->has_value());
  const Time almost = kNoon + kPolicy.heartbeat - Milliseconds(1);
  EXPECT_FALSE(decide_heartbeat(running(), question, almost, kPolicy)->has_value());
  const JobRecord prolonged =
      after(decide_heartbeat(running(), question, kNoon + kPolicy.heartbeat, kPolicy));
  EXPECT_EQ(prolonged.lease.expires, kNoon + kPolicy.heartbeat + kPolicy.lease);
}

TEST(Heartbeat, PrinterResultBecomesAnEventOnceAndUpdatesTheJob) {
  auto request = heartbeat("job", 7);
  request.add_printers()->set_printer_id("p");
  request.mutable_printers(0)->set_state(v1::JOB_STATE_SUCCEEDED);
  const Decision first = decide_heartbeat(running(), request, kNoon, kPolicy);
  EXPECT_EQ((*first)->events.size(), 1u);
  EXPECT_EQ(after(first).job.printers_size(), 1);
  const Decision again = decide_heartbeat(after(first), request, kNoon, kPolicy);
  EXPECT_TRUE((*again)->events.empty());
  EXPECT_EQ(after(again).job.printers_size(), 1);
}

v1::CheckpointRequest checkpoint(std::int64_t token, const std::string& sha256) {
  v1::CheckpointRequest request;
  request.set_job_id("job");
  request.set_fencing_token(token);
  request.mutable_checkpoint()->set_sha256(sha256);
  request.mutable_checkpoint()->set_attempt(99);  // the server knows better
  return request;
}

TEST(Checkpoint, IsKeptOverALostAttemptAndGoesWithTheEnd) {
  const JobRecord kept = after(decide_checkpoint(running(), checkpoint(7, "one")));
  EXPECT_EQ(kept.job.checkpoint().attempt(), 1);
  EXPECT_FALSE(decide_checkpoint(kept, checkpoint(7, "one"))->has_value());
  const JobRecord expired = after(decide_lease_expired(kept, kNoon + kPolicy.lease, kPolicy));
  EXPECT_EQ(expired.job.checkpoint().sha256(), "one");
  const auto handed_back = completion("job", 7, v1::JOB_STATE_CANCELLED);
  EXPECT_TRUE(after(decide_complete(kept, handed_back, kNoon, kPolicy)).job.has_checkpoint());
  const auto done = completion("job", 7, v1::JOB_STATE_SUCCEEDED);
  EXPECT_FALSE(after(decide_complete(kept, done, kNoon, kPolicy)).job.has_checkpoint());
  EXPECT_FALSE(after(decide_cancel(expired, kNoon, kPolicy)).job.has_checkpoint());
}

TEST(Checkpoint, OfAStaleTokenIsAborted) {
  EXPECT_TRUE(absl::IsAborted(decide_checkpoint(running(7), checkpoint(6, "late")).status()));
  EXPECT_TRUE(absl::IsAborted(decide_checkpoint(queued(), checkpoint(7, "late")).status()));
}

TEST(Checkpoint, AProcessThatDiesOfItIsNotGivenItAgain) {
  const JobRecord kept = after(decide_checkpoint(running(), checkpoint(7, "one")));
  const JobRecord first = after(decide_complete(kept, crash(), kNoon, kPolicy));
  EXPECT_TRUE(first.job.has_checkpoint()) << "it made it, so it got further than its beginning";
  const JobRecord again = leased(first, 8).record;
  EXPECT_FALSE(after(decide_complete(again, crash(8), kNoon, kPolicy)).job.has_checkpoint());
}

TEST(Complete, SucceedsWithFilesAndTellsPrintersBeforeTheState) {
  auto request = completion("job", 7, v1::JOB_STATE_SUCCEEDED, v1::REASON_PARTIAL);
  request.add_printers()->set_printer_id("p");
  request.add_files()->set_path("report.json");
  const Decision decision = decide_complete(running(), request, kNoon, kPolicy);
  const JobRecord job = after(decision);
  EXPECT_EQ(job.job.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job.job.reason(), v1::REASON_PARTIAL);
  EXPECT_EQ(job.job.files_size(), 1);
  ASSERT_EQ((*decision)->events.size(), 2u);
  EXPECT_TRUE((*decision)->events[0].has_printer());
  EXPECT_TRUE((*decision)->events[1].has_state());
}

TEST(Complete, TheSameTwiceCountsOnceAndAnotherIsAborted) {
  const auto request = completion("job", 7, v1::JOB_STATE_SUCCEEDED);
  const JobRecord done = after(decide_complete(running(), request, kNoon, kPolicy));
  const Decision again = decide_complete(done, request, kNoon, kPolicy);
  ASSERT_TRUE(again.ok());
  EXPECT_FALSE(again->has_value());
  const auto other = completion("job", 7, v1::JOB_STATE_FAILED, v1::REASON_INTERNAL);
  EXPECT_TRUE(absl::IsAborted(decide_complete(done, other, kNoon, kPolicy).status()));
}

TEST(Complete, RetryableTwiceLosesOneAttempt) {
  const JobRecord once = after(decide_complete(running(), crash(), kNoon, kPolicy));
  EXPECT_EQ(once.lost_attempts, 1);
  EXPECT_FALSE(decide_complete(once, crash(), kNoon, kPolicy)->has_value());
}

TEST(Complete, FinishedWorkIsKeptThoughCancellationWasAsked) {
  const JobRecord asked = after(decide_cancel(running(), kNoon, kPolicy));
  const JobRecord done =
      after(decide_complete(asked, completion("job", 7, v1::JOB_STATE_SUCCEEDED), kNoon, kPolicy));
  EXPECT_EQ(done.job.state(), v1::JOB_STATE_SUCCEEDED);
}

TEST(Complete, CancelledEndsAJobThatWasAskedTo) {
  const JobRecord asked = after(decide_cancel(running(), kNoon, kPolicy));
  const JobRecord done =
      after(decide_complete(asked, completion("job", 7, v1::JOB_STATE_CANCELLED), kNoon, kPolicy));
  EXPECT_EQ(done.job.state(), v1::JOB_STATE_CANCELLED);
}

TEST(Complete, CancelledWithoutAnybodysWishQueuesAgainAtOnceAndLosesNoAttempt) {
  JobRecord record = running();
  record.lost_attempts = kPolicy.max_attempts - 1;  // one more would end the job
  record.job.add_printers()->set_printer_id("p");
  const Time now = kNoon + seconds(3);
  const Decision decision =
      decide_complete(record, completion("job", 7, v1::JOB_STATE_CANCELLED), now, kPolicy);
  const JobRecord job = after(decision);
  EXPECT_EQ(job.job.state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(job.lost_attempts, record.lost_attempts);
  EXPECT_EQ(job.not_before, now);
  EXPECT_EQ(job.job.printers_size(), 0);
  ASSERT_EQ((*decision)->events.size(), 1u);
  EXPECT_EQ((*decision)->events[0].state().detail(), "its worker stopped; queued again");
}

TEST(Complete, HandedBackTwiceIsQueuedOnce) {
  const auto request = completion("job", 7, v1::JOB_STATE_CANCELLED);
  const JobRecord once = after(decide_complete(running(), request, kNoon, kPolicy));
  const Decision again = decide_complete(once, request, kNoon, kPolicy);
  ASSERT_TRUE(again.ok());
  EXPECT_FALSE(again->has_value());
}

TEST(LostAttempt, QueuesAgainNotBeforeTheBackoffAndForgetsPrinters) {
  JobRecord job = running();
  job.job.add_printers()->set_printer_id("p");
  const JobRecord again = after(decide_lease_expired(job, kNoon + kPolicy.lease, kPolicy));
  EXPECT_EQ(again.job.state(), v1::JOB_STATE_QUEUED);
  EXPECT_GE(again.not_before, kNoon + kPolicy.lease + kPolicy.first_backoff / 2);
  EXPECT_EQ(again.job.printers_size(), 0);
  EXPECT_NE(again.job.detail().find("attempt 1 of 3 lost"), std::string::npos) << again.job.detail();
}

TEST(LostAttempt, ThirdOneFailsTheJobWithItsLastReason) {
  JobRecord job = queued();
  for (int attempt = 1; attempt <= 2; ++attempt) {
    job = after(decide_complete(leased(job, attempt).record, crash(attempt), kNoon, kPolicy));
    EXPECT_EQ(job.job.state(), v1::JOB_STATE_QUEUED) << attempt;
  }
  auto last = crash(3);
  last.set_reason(v1::REASON_OUT_OF_MEMORY);
  job = after(decide_complete(leased(job, 3).record, last, kNoon, kPolicy));
  EXPECT_EQ(job.job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job.job.reason(), v1::REASON_OUT_OF_MEMORY);
  EXPECT_NE(job.job.detail().find("3 attempts"), std::string::npos) << job.job.detail();
}

TEST(LeaseExpiry, DoesNothingToALeaseThatWasProlonged) {
  EXPECT_FALSE(
      decide_lease_expired(running(), kNoon + kPolicy.lease - Milliseconds(1), kPolicy)->has_value());
}

TEST(LeaseExpiry, OfAJobAskedToStopCancelsIt) {
  const JobRecord asked = after(decide_cancel(running(), kNoon, kPolicy));
  EXPECT_EQ(after(decide_lease_expired(asked, kNoon + kPolicy.lease, kPolicy)).job.state(),
            v1::JOB_STATE_CANCELLED);
}

TEST(Deadline, EndsAQueuedJobAndStopsARunningOne) {
  JobRecord record = example_record("job");
  record.job.mutable_spec()->mutable_deadline()->set_seconds(60);
  const JobRecord job = decide_submit(record, kNoon, kPolicy).record;
  EXPECT_FALSE(decide_deadline(job, kNoon + Milliseconds(59'999))->has_value());
  const JobRecord late = after(decide_deadline(job, kNoon + seconds(60)));
  EXPECT_EQ(late.job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(late.job.reason(), v1::REASON_TIMED_OUT);

  const JobRecord started = leased(job, 7).record;
  EXPECT_FALSE(decide_deadline(started, kNoon + seconds(60))->has_value());
  EXPECT_TRUE(must_stop(started, kNoon + seconds(60)));
  const JobRecord stopped = after(
      decide_complete(started, completion("job", 7, v1::JOB_STATE_CANCELLED), kNoon + seconds(61), kPolicy));
  EXPECT_EQ(stopped.job.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(stopped.job.reason(), v1::REASON_TIMED_OUT);
}

TEST(WarmStart, IsFromASucceededJobOfTheSameMeshOnly) {
  const v1::JobSpec same = queued().job.spec();
  EXPECT_TRUE(absl::IsFailedPrecondition(permit_warm_start(queued(), same)));
  EXPECT_TRUE(absl::IsFailedPrecondition(permit_warm_start(running(), same)));
  JobRecord done = running();
  done.job.set_state(v1::JOB_STATE_SUCCEEDED);
  EXPECT_TRUE(permit_warm_start(done, same).ok());
  v1::JobSpec other = same;
  other.set_mesh_sha256(std::string(64, 'b'));
  EXPECT_TRUE(absl::IsInvalidArgument(permit_warm_start(done, other)));
  done.job.mutable_spec()->set_frame_problem_sha256(std::string(64, 'a'));
  EXPECT_TRUE(absl::IsInvalidArgument(permit_warm_start(done, same)));
}

TEST(Delete, IsForEndedJobsOnly) {
  EXPECT_TRUE(absl::IsFailedPrecondition(permit_delete(queued())));
  EXPECT_TRUE(absl::IsFailedPrecondition(permit_delete(running())));
  EXPECT_TRUE(permit_delete(after(decide_cancel(queued(), kNoon, kPolicy))).ok());
}

}  // namespace
}  // namespace skinframe::server
