// SPDX-License-Identifier: Apache-2.0
// What one job's events may say, judged from outside with rules of its own: it shares nothing with the server
// but the API's messages.
//
//   - sequence numbers are 1, 2, 3 ... as a watcher receives them, over every reconnection
//   - QUEUED comes first, RUNNING only after QUEUED, and each RUNNING is the next attempt
//   - progress is of the attempt that runs: none of an earlier one (stale), none while nobody has the lease
//   - exactly one end, and nothing after it
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "skinframe/v1/job.pb.h"

namespace skinframe::faults {

class JobJudge {
 public:
  void see(const v1::JobEvent& event);
  // The job as GetJob tells it after the end.
  void see_job(const v1::Job& job);
  // A worker said that this attempt's success was accepted.
  void see_acceptance(int attempt);

  bool ended() const { return ended_; }
  v1::JobState state() const { return state_; }
  int attempt() const { return attempt_; }
  std::int64_t last_sequence() const { return last_sequence_; }
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  void see_state(const v1::StateChange& change);
  void fault(const std::string& what) { faults_.push_back(what); }

  v1::JobState state_ = v1::JOB_STATE_UNSPECIFIED;
  int attempt_ = 0;
  std::int64_t last_sequence_ = 0;
  bool ended_ = false;
  std::optional<int> accepted_;
  std::vector<std::string> faults_;
};

}  // namespace skinframe::faults
