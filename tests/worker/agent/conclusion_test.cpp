// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/conclusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "worker/agent/progress_batch.h"

namespace skinframe::agent {
namespace {

Outcome outcome(v1::JobState state, v1::Reason reason) {
  Outcome out;
  out.state = state;
  out.reason = reason;
  return out;
}

TEST(Conclusion, AWholeResultIsUploadedEvenWhenTheStopCameAMomentLater) {
  for (const StopCause stop : {StopCause::kNone, StopCause::kCancelled, StopCause::kWorkerStopped}) {
    AttemptEnd end;
    end.stop = stop;
    end.outcome = outcome(v1::JOB_STATE_SUCCEEDED, v1::REASON_UNSPECIFIED);
    const Conclusion c = conclude(end);
    EXPECT_EQ(c.outcome.state, v1::JOB_STATE_SUCCEEDED);
    EXPECT_TRUE(c.upload);
    EXPECT_FALSE(c.retryable);
  }
}

TEST(Conclusion, AnInfeasibleJobIsAResultAndNotTriedAgain) {
  AttemptEnd end;
  end.outcome = outcome(v1::JOB_STATE_FAILED, v1::REASON_INFEASIBLE);
  EXPECT_FALSE(conclude(end).retryable);
  EXPECT_TRUE(conclude(end).upload);
}

TEST(Conclusion, ACrashIsRetryableAndNamesTheSignalAndTheLastWords) {
  AttemptEnd end;
  end.exit.signal = SIGSEGV;
  end.last_log_lines = "sampling 380 nodes";
  const Conclusion c = conclude(end);
  EXPECT_EQ(c.outcome.reason, v1::REASON_CRASHED);
  EXPECT_TRUE(c.retryable);
  EXPECT_FALSE(c.upload);
  EXPECT_THAT(c.outcome.detail,
              testing::AllOf(testing::HasSubstr("SIGSEGV"), testing::HasSubstr("380 nodes")));
}

TEST(Conclusion, AProcessThatLeavesWithoutOutcomeHasCrashedWhateverItsCode) {
  EXPECT_EQ(conclude({}).outcome.reason, v1::REASON_CRASHED);
}

TEST(Conclusion, WantOfMemoryIsToldFromACrash) {
  AttemptEnd thrown;
  thrown.exit.signal = SIGABRT;
  thrown.last_log_lines = "terminate called after throwing an instance of 'std::bad_alloc'";
  thrown.memory_limit_mb = 512;
  EXPECT_EQ(conclude(thrown).outcome.reason, v1::REASON_OUT_OF_MEMORY);
  EXPECT_THAT(conclude(thrown).outcome.detail, testing::HasSubstr("512 MB"));
  EXPECT_TRUE(conclude(thrown).retryable);
  AttemptEnd no_thread;  // whose stack finds no room
  no_thread.exit.signal = SIGABRT;
  no_thread.last_log_lines =
      "terminate called after throwing an instance of 'std::system_error'\n  what():  Resource temporarily "
      "unavailable";
  EXPECT_EQ(conclude(no_thread).outcome.reason, v1::REASON_CRASHED) << "nothing limits its memory";
  no_thread.memory_limit_mb = 300;
  EXPECT_EQ(conclude(no_thread).outcome.reason, v1::REASON_OUT_OF_MEMORY);
  AttemptEnd told;
  told.outcome = outcome(v1::JOB_STATE_FAILED, v1::REASON_OUT_OF_MEMORY);
  EXPECT_TRUE(conclude(told).retryable);
  EXPECT_FALSE(conclude(told).upload);
}

TEST(Conclusion, WhoStoppedItDecidesHowItEnded) {
  AttemptEnd end;
  end.exit.signal = SIGKILL;
  end.stop = StopCause::kCancelled;
  EXPECT_EQ(conclude(end).outcome.state, v1::JOB_STATE_CANCELLED);
  end.stop = StopCause::kDeadline;
  EXPECT_EQ(conclude(end).outcome.reason, v1::REASON_TIMED_OUT);
  EXPECT_FALSE(conclude(end).retryable);
  end.stop = StopCause::kWorkerStopped;
  EXPECT_EQ(conclude(end).outcome.state, v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(conclude(end).outcome.detail, "worker stopped");
  EXPECT_FALSE(conclude(end).retryable);
}

TEST(Conclusion, ALostLeaseIsReportedToNobodyNotEvenASuccess) {
  AttemptEnd end;
  end.stop = StopCause::kLeaseLost;
  end.outcome = outcome(v1::JOB_STATE_SUCCEEDED, v1::REASON_UNSPECIFIED);
  EXPECT_FALSE(conclude(end).report);
}

v1::JobProgress tick(const char* stage, int iteration, double volume) {
  v1::JobProgress p;
  p.set_stage(stage);
  p.set_iteration(iteration);
  p.set_total_volume_mm3(volume);
  return p;
}

TEST(ProgressBatch, TicksOfOneIterationBecomeTheNewest) {
  ProgressBatch batch;
  batch.add(tick("size", 1, 10));
  batch.add(tick("size", 1, 9));
  batch.add(tick("size", 2, 8));
  v1::HeartbeatRequest request;
  batch.take(request);
  ASSERT_EQ(request.progress_size(), 2);
  EXPECT_EQ(request.progress(0).total_volume_mm3(), 9);
  EXPECT_EQ(request.progress(1).total_volume_mm3(), 8);
}

TEST(ProgressBatch, ATickBecomesTheNewestOfItsPrinterAlsoBetweenThoseOfAnother) {
  ProgressBatch batch;
  for (const double volume : {3.0, 2.0, 1.0})
    for (const char* printer : {"one", "two"}) {
      v1::JobProgress progress;
      progress.set_printer_id(printer);
      progress.set_stage("size");
      progress.set_iteration(4);
      progress.set_frame_volume_mm3(volume);
      batch.add(progress);
    }
  v1::HeartbeatRequest request;
  batch.take(request);
  ASSERT_EQ(request.progress_size(), 2);
  for (const v1::JobProgress& progress : request.progress()) EXPECT_EQ(progress.frame_volume_mm3(), 1.0);
}

TEST(ProgressBatch, WithNothingNewTheLastKnownIsToldAgain) {
  ProgressBatch batch;
  v1::HeartbeatRequest before;
  batch.take(before);
  EXPECT_EQ(before.progress_size(), 0);
  batch.add(tick("size", 2, 8));
  v1::HeartbeatRequest first, second;
  batch.take(first);
  batch.take(second);
  ASSERT_EQ(second.progress_size(), 1);
  EXPECT_EQ(second.progress(0).iteration(), 2);
}

TEST(ProgressBatch, ALostHeartbeatLosesNoPrinterAndKeepsTheOrder) {
  ProgressBatch batch;
  batch.add(tick("size", 1, 10));
  v1::PrinterResult printer;
  printer.set_printer_id("a");
  batch.add(printer);
  v1::HeartbeatRequest lost, next;
  batch.take(lost);
  batch.add(tick("size", 2, 9));
  batch.give_back(lost);
  batch.take(next);
  ASSERT_EQ(next.progress_size(), 2);
  EXPECT_EQ(next.progress(0).iteration(), 1);
  ASSERT_EQ(next.printers_size(), 1);
}

TEST(ProgressBatch, NeverExceedsWhatAHeartbeatTakes) {
  ProgressBatch batch;
  for (int i = 0; i < 1000; ++i) batch.add(tick("size", i, 1));
  v1::HeartbeatRequest request;
  batch.take(request);
  EXPECT_EQ(request.progress_size(), 100);
  EXPECT_EQ(request.progress(99).iteration(), 999);
}

}  // namespace
}  // namespace skinframe::agent
