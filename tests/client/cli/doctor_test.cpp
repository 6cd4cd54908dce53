// SPDX-License-Identifier: Apache-2.0
#include "client/cli/doctor.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace skinframe::client {
namespace {

constexpr std::int64_t kAsked = 1'700'000'000'000;

v1::ServerInfo healthy() {
  v1::ServerInfo info;
  info.set_version(SKINFRAME_VERSION);
  info.mutable_time()->set_seconds(kAsked / 1000);
  info.set_tenant("north");
  info.set_store("sqlite");
  info.set_artifact_bytes_free(std::int64_t{100} << 30);
  info.set_workers_waiting(2);
  return info;
}

Finding finding(const v1::ServerInfo& info, const std::string& what, std::int64_t took_ms = 10) {
  const auto all = examine(info, kAsked, kAsked + took_ms);
  const auto at = std::find_if(all.begin(), all.end(), [&](const Examined& one) { return one.what == what; });
  EXPECT_NE(at, all.end()) << what;
  return at == all.end() ? Finding::kWrong : at->finding;
}

TEST(Doctor, FindsNothingAtAHealthyServer) {
  for (const Examined& one : examine(healthy(), kAsked, kAsked + 10))
    EXPECT_EQ(one.finding, Finding::kWell) << one.what << ": " << one.says;
}

TEST(Doctor, NotesAnotherVersionAndThatNoWorkerWaits) {
  v1::ServerInfo info = healthy();
  info.set_version("9.9.9");
  info.set_workers_waiting(0);
  EXPECT_EQ(finding(info, "version"), Finding::kNote);
  EXPECT_EQ(finding(info, "workers"), Finding::kNote);
}

TEST(Doctor, AClockCountsAsWrongOnlyByWhatTheJourneyCannotExplain) {
  v1::ServerInfo info = healthy();
  info.mutable_time()->set_seconds(kAsked / 1000 + 30);
  EXPECT_EQ(finding(info, "clock"), Finding::kWrong);
  EXPECT_EQ(finding(info, "clock", 58'000), Finding::kWell) << "29 s on the way there, as far as we know";
  info.mutable_time()->set_seconds(kAsked / 1000 - 5);
  EXPECT_EQ(finding(info, "clock"), Finding::kNote);
}

TEST(Doctor, LittleRoomIsNotedAndNoneIsWrongOnDiskAndInTheQuota) {
  v1::ServerInfo info = healthy();
  info.set_artifact_bytes_free(std::int64_t{1} << 30);
  info.set_artifact_bytes_left(1000);
  EXPECT_EQ(finding(info, "disk there"), Finding::kNote);
  EXPECT_EQ(finding(info, "quota"), Finding::kWrong);
}

}  // namespace
}  // namespace skinframe::client
