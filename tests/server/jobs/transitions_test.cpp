// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/transitions.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

namespace skinframe::server {
namespace {

constexpr v1::JobState kStates[] = {v1::JOB_STATE_UNSPECIFIED, v1::JOB_STATE_QUEUED, v1::JOB_STATE_RUNNING,
                                    v1::JOB_STATE_SUCCEEDED,   v1::JOB_STATE_FAILED, v1::JOB_STATE_CANCELLED};

// The picture in job.proto, written down once more and independently.
const std::map<std::pair<v1::JobState, Trigger>, v1::JobState> kPicture = {
    {{v1::JOB_STATE_QUEUED, Trigger::kLeased}, v1::JOB_STATE_RUNNING},
    {{v1::JOB_STATE_QUEUED, Trigger::kCancelled}, v1::JOB_STATE_CANCELLED},
    {{v1::JOB_STATE_QUEUED, Trigger::kDeadlinePassed}, v1::JOB_STATE_FAILED},
    {{v1::JOB_STATE_RUNNING, Trigger::kSucceeded}, v1::JOB_STATE_SUCCEEDED},
    {{v1::JOB_STATE_RUNNING, Trigger::kFailed}, v1::JOB_STATE_FAILED},
    {{v1::JOB_STATE_RUNNING, Trigger::kAttemptLost}, v1::JOB_STATE_QUEUED},
    {{v1::JOB_STATE_RUNNING, Trigger::kHandedBack}, v1::JOB_STATE_QUEUED},
    {{v1::JOB_STATE_RUNNING, Trigger::kAttemptsUsedUp}, v1::JOB_STATE_FAILED},
    {{v1::JOB_STATE_RUNNING, Trigger::kCancelled}, v1::JOB_STATE_CANCELLED},
    {{v1::JOB_STATE_RUNNING, Trigger::kDeadlinePassed}, v1::JOB_STATE_FAILED},
};

TEST(Transitions, EveryStateAndTriggerGoesWhereThePictureSays) {
  for (const v1::JobState from : kStates) {
    for (const Trigger trigger : all_triggers()) {
      const auto expected = kPicture.find({from, trigger});
      const auto actual = next_state(from, trigger);
      if (expected == kPicture.end()) {
        EXPECT_FALSE(actual.has_value()) << state_name(from) << " by " << trigger_name(trigger);
      } else {
        EXPECT_EQ(actual, expected->second) << state_name(from) << " by " << trigger_name(trigger);
      }
    }
  }
}

TEST(Transitions, NoArrowIsThereTwice) {
  std::set<std::pair<v1::JobState, Trigger>> arrows;
  for (const Transition& arrow : all_transitions())
    EXPECT_TRUE(arrows.insert({arrow.from, arrow.trigger}).second);
  EXPECT_EQ(arrows.size(), kPicture.size());
}

TEST(Transitions, NoArrowLeavesAFinalState) {
  for (const Transition& arrow : all_transitions())
    EXPECT_FALSE(is_final(arrow.from)) << state_name(arrow.from);
}

TEST(Transitions, EveryStateCanBeReachedFromQueued) {
  std::set<v1::JobState> reached = {v1::JOB_STATE_QUEUED};
  for (std::size_t round = 0; round < all_transitions().size(); ++round) {
    for (const Transition& arrow : all_transitions()) {
      if (reached.contains(arrow.from)) reached.insert(arrow.to);
    }
  }
  EXPECT_EQ(reached.size(), 5u);
}

TEST(Transitions, NamesAreThoseOfTheApiWithoutPrefix) {
  EXPECT_EQ(state_name(v1::JOB_STATE_CANCELLED), "CANCELLED");
  EXPECT_EQ(reason_name(v1::REASON_OUT_OF_MEMORY), "OUT_OF_MEMORY");
  EXPECT_EQ(reason_name(v1::REASON_UNSPECIFIED), "NONE");
}

}  // namespace
}  // namespace skinframe::server
