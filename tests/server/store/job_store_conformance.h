// SPDX-License-Identifier: Apache-2.0
// What every store guarantees (server/store/job_store.h), whatever it is built on: the suite's fixture. Its
// tests stand in jobs_, queue_ and events_conformance_test.cpp.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/server/fixture/example_job.h"
#include "tests/server/store/store_factory.h"

namespace skinframe::server {

inline constexpr std::int64_t kNoLimit = 1'000'000;
inline const AttemptPolicy kPolicy;

class JobStoreConformance : public testing::TestWithParam<StoreKind> {
 protected:
  void SetUp() override {
    place_ = GetParam().make_place();
    store_ = place_->open(nullptr);
  }
  void reopen() {
    store_.reset();
    store_ = place_->open(nullptr);
  }
  void create(const std::string& job_id, int priority = 0) {
    ASSERT_TRUE(store_->create(example_job(job_id, priority), kNoLimit).ok());
  }
  std::optional<JobRecord> lease(Time now = kNoon) {
    auto record = store_->lease_next(
        now, [now](const JobRecord& job, std::int64_t token) { return leased(job, token, now); });
    EXPECT_TRUE(record.ok()) << record.status();
    return record.ok() ? *record : std::nullopt;
  }
  absl::StatusOr<JobRecord> beat(const std::string& job_id, std::int64_t token, int progress) {
    auto request = heartbeat(job_id, token);
    for (int i = 0; i < progress; ++i) request.add_progress()->set_iteration(i);
    return store_->modify(
        job_id, [&](const JobRecord& job) { return decide_heartbeat(job, request, kNoon, kPolicy); });
  }
  absl::Status cancel(const std::string& job_id) {
    return store_
        ->modify(job_id, [](const JobRecord& job) { return decide_cancel(job, kNoon, AttemptPolicy{}); })
        .status();
  }
  std::vector<std::string> listed(const ListQuery& query) {
    auto page = store_->list(query);
    EXPECT_TRUE(page.ok()) << page.status();
    std::vector<std::string> ids;
    for (const auto& entry : page->entries) ids.push_back(entry.job.job_id());
    return ids;
  }

  std::unique_ptr<StorePlace> place_;
  std::unique_ptr<JobStore> store_;
};

}  // namespace skinframe::server
