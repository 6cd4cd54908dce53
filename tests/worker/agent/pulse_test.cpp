// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/pulse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/fixture/temporary_folder.h"

namespace skinframe::agent {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

class PulseTest : public testing::Test {
 protected:
  void leave_pulse(const std::string& agent, std::chrono::seconds ago) {
    std::filesystem::create_directory(folder_.path() / agent);
    std::ofstream(folder_.path() / agent / "connected");
    std::filesystem::last_write_time(folder_.path() / agent / "connected", now_ - ago);
  }
  Status check() const { return check_pulse(folder_.path(), now_); }

  test::TemporaryFolder folder_;
  std::filesystem::file_time_type now_ = std::filesystem::file_time_type::clock::now();
};

TEST_F(PulseTest, AWorkerThatHasNeverReachedItsServerIsNotHealthy) {
  EXPECT_THAT(check().error().message, HasSubstr("has reached its server yet"));
  std::filesystem::create_directory(folder_.path() / "agent-new");
  EXPECT_FALSE(check().ok());
}

TEST_F(PulseTest, TheNewestPulseCounts) {
  leave_pulse("agent-killed", 3h);
  EXPECT_THAT(check().error().message, HasSubstr("10800 s ago"));
  leave_pulse("agent-alive", 10s);
  EXPECT_TRUE(check().ok());
}

TEST_F(PulseTest, AMissingWorkFolderIsNamed) {
  EXPECT_THAT(check_pulse("/nowhere/work", now_).error().message, HasSubstr("/nowhere/work"));
}

}  // namespace
}  // namespace skinframe::agent
