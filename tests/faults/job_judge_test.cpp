// SPDX-License-Identifier: Apache-2.0
// The judge of the other tests here can say no.
#include "tests/faults/job_judge.h"

#include <gtest/gtest.h>

namespace skinframe::faults {
namespace {

class Judge : public testing::Test {
 protected:
  void state(v1::JobState state, int attempt) {
    v1::JobEvent event = next();
    event.mutable_state()->set_state(state);
    event.mutable_state()->set_attempt(attempt);
    judge_.see(event);
  }
  void progress(int attempt) {
    v1::JobEvent event = next();
    event.mutable_progress()->set_attempt(attempt);
    judge_.see(event);
  }
  void skip_one() { ++sequence_; }
  v1::JobEvent next() {
    v1::JobEvent event;
    event.set_sequence(++sequence_);
    return event;
  }
  void run_twice() {
    state(v1::JOB_STATE_QUEUED, 0);
    state(v1::JOB_STATE_RUNNING, 1);
    progress(1);
    state(v1::JOB_STATE_QUEUED, 1);
    state(v1::JOB_STATE_RUNNING, 2);
    progress(2);
  }
  std::size_t faults() const { return judge_.faults().size(); }

  JobJudge judge_;
  std::int64_t sequence_ = 0;
};

TEST_F(Judge, FindsNothingInAJobThatWasRescuedOnce) {
  run_twice();
  state(v1::JOB_STATE_SUCCEEDED, 2);
  judge_.see_acceptance(2);
  judge_.see_acceptance(2);  // the same completion sent again
  v1::Job job;
  job.set_state(v1::JOB_STATE_SUCCEEDED);
  job.set_attempt(2);
  job.set_last_sequence(sequence_);
  judge_.see_job(job);
  EXPECT_EQ(faults(), 0u) << judge_.faults().front();
}

TEST_F(Judge, FindsAGapAndARepetition) {
  run_twice();
  skip_one();
  progress(2);
  EXPECT_EQ(faults(), 1u);
  sequence_ = 3;
  progress(2);
  EXPECT_EQ(faults(), 2u);
}

TEST_F(Judge, FindsProgressOfAnEarlierAttempt) {
  run_twice();
  progress(1);
  EXPECT_EQ(faults(), 1u);
}

TEST_F(Judge, FindsASecondEnd) {
  run_twice();
  state(v1::JOB_STATE_SUCCEEDED, 2);
  state(v1::JOB_STATE_SUCCEEDED, 2);
  EXPECT_GE(faults(), 1u);
}

TEST_F(Judge, FindsTheAcceptedResultOfAnAttemptThatIsOver) {
  run_twice();
  state(v1::JOB_STATE_SUCCEEDED, 2);
  judge_.see_acceptance(1);
  EXPECT_EQ(faults(), 1u);
  judge_.see_acceptance(2);
  EXPECT_EQ(faults(), 2u);
}

TEST_F(Judge, FindsALostEventAtTheEndAndAJobThatDoesNotEnd) {
  run_twice();
  v1::Job job;
  job.set_state(v1::JOB_STATE_RUNNING);
  job.set_attempt(2);
  job.set_last_sequence(sequence_ + 1);
  judge_.see_job(job);
  EXPECT_EQ(faults(), 2u);
}

}  // namespace
}  // namespace skinframe::faults
