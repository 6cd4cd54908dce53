// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/job_judge.h"

namespace skinframe::faults {
namespace {

std::string place(std::int64_t sequence) { return "event " + std::to_string(sequence) + ": "; }

bool is_end(v1::JobState state) {
  return state == v1::JOB_STATE_SUCCEEDED || state == v1::JOB_STATE_FAILED ||
         state == v1::JOB_STATE_CANCELLED;
}

}  // namespace

void JobJudge::see(const v1::JobEvent& event) {
  if (event.sequence() != last_sequence_ + 1)
    fault(place(event.sequence()) + "comes after " + std::to_string(last_sequence_));
  last_sequence_ = event.sequence();
  if (ended_) fault(place(event.sequence()) + "comes after the end");
  if (event.has_state()) see_state(event.state());
  if (event.has_progress()) {
    if (state_ != v1::JOB_STATE_RUNNING)
      fault(place(event.sequence()) + "progress while nobody has the lease");
    if (event.progress().attempt() != attempt_)
      fault(place(event.sequence()) + "progress of attempt " + std::to_string(event.progress().attempt()) +
            " in attempt " + std::to_string(attempt_));
  }
}

void JobJudge::see_state(const v1::StateChange& change) {
  const std::string here = place(last_sequence_) + v1::JobState_Name(change.state());
  switch (change.state()) {
    case v1::JOB_STATE_QUEUED:
      if (state_ != v1::JOB_STATE_UNSPECIFIED && state_ != v1::JOB_STATE_RUNNING)
        fault(here + " after " + v1::JobState_Name(state_));
      break;
    case v1::JOB_STATE_RUNNING:
      if (state_ != v1::JOB_STATE_QUEUED) fault(here + " after " + v1::JobState_Name(state_));
      if (change.attempt() != attempt_ + 1)
        fault(here + " is attempt " + std::to_string(change.attempt()) + " after attempt " +
              std::to_string(attempt_));
      attempt_ = change.attempt();
      break;
    default:
      if (state_ != v1::JOB_STATE_RUNNING && state_ != v1::JOB_STATE_QUEUED)
        fault(here + " after " + v1::JobState_Name(state_));
      if (change.attempt() != attempt_) fault(here + " of attempt " + std::to_string(change.attempt()));
  }
  state_ = change.state();
  ended_ = ended_ || is_end(state_);
}

void JobJudge::see_job(const v1::Job& job) {
  if (!ended_) fault("it was not seen to end");
  if (job.state() != state_) fault("GetJob says " + v1::JobState_Name(job.state()));
  if (job.last_sequence() != last_sequence_)
    fault("GetJob knows " + std::to_string(job.last_sequence()) + " events, the watch " +
          std::to_string(last_sequence_));
  if (job.attempt() != attempt_) fault("GetJob says attempt " + std::to_string(job.attempt()));
}

void JobJudge::see_acceptance(int attempt) {
  if (accepted_ && *accepted_ != attempt)
    fault("results of attempts " + std::to_string(*accepted_) + " and " + std::to_string(attempt) +
          " were both accepted");
  accepted_ = attempt;
  if (ended_ && attempt != attempt_)
    fault("the result of attempt " + std::to_string(attempt) + " was accepted, the job ended with attempt " +
          std::to_string(attempt_));
}

}  // namespace skinframe::faults
