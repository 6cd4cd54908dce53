// SPDX-License-Identifier: Apache-2.0
#include "client/cli/exit_code.h"

#include <gtest/gtest.h>

#include <vector>

namespace skinframe::client {
namespace {

TEST(ExitCodes, AreThoseOfTheTable) {
  struct Case {
    v1::JobState state;
    v1::Reason reason;
    int code;
  };
  const std::vector<Case> cases = {{v1::JOB_STATE_SUCCEEDED, v1::REASON_UNSPECIFIED, 0},
                                   {v1::JOB_STATE_SUCCEEDED, v1::REASON_PARTIAL, 8},
                                   {v1::JOB_STATE_FAILED, v1::REASON_INVALID_INPUT, 3},
                                   {v1::JOB_STATE_FAILED, v1::REASON_DOES_NOT_FIT, 3},
                                   {v1::JOB_STATE_FAILED, v1::REASON_INFEASIBLE, 4},
                                   {v1::JOB_STATE_FAILED, v1::REASON_CRASHED, 5},
                                   {v1::JOB_STATE_FAILED, v1::REASON_TIMED_OUT, 5},
                                   {v1::JOB_STATE_FAILED, v1::REASON_OUT_OF_MEMORY, 5},
                                   {v1::JOB_STATE_FAILED, v1::REASON_INTERNAL, 5},
                                   {v1::JOB_STATE_FAILED, v1::REASON_UNSUPPORTED, 2},
                                   {v1::JOB_STATE_CANCELLED, v1::REASON_CANCELLED, 6},
                                   {v1::JOB_STATE_CANCELLED, v1::REASON_UNSPECIFIED, 6}};
  for (const Case& c : cases) {
    EXPECT_EQ(exit_code(c.state, c.reason), c.code)
        << v1::JobState_Name(c.state) << " " << v1::Reason_Name(c.reason);
  }
}

TEST(ExitCodes, OfCallsThatDidNotWork) {
  EXPECT_EQ(exit_code(FailureKind::kUsage), 2);
  EXPECT_EQ(exit_code(FailureKind::kInput), 3);
  EXPECT_EQ(exit_code(FailureKind::kInternal), 5);
  EXPECT_EQ(exit_code(FailureKind::kLocal), 5);
  EXPECT_EQ(exit_code(FailureKind::kInterrupted), 6);
  EXPECT_EQ(exit_code(FailureKind::kUnreachable), 7);
  EXPECT_EQ(exit_code(FailureKind::kNotFound), 9);
}

}  // namespace
}  // namespace skinframe::client
