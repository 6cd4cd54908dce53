// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/artifacts/upload.h"
#include "server/jobs/job_id.h"
#include "server/retention/artifact_cleaner.h"
#include "server/retention/job_retention.h"
#include "server/store/sqlite_store.h"
#include "tests/server/fixture/example_job.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

constexpr Milliseconds kDay{24 * 3'600'000};
constexpr Milliseconds kHour{3'600'000};

class Retention : public testing::Test {
 protected:
  Retention()
      : store_(*open_sqlite_store(folder_.path() / "jobs.sqlite", nullptr)),
        shelves_(*TenantArtifacts::open(folder_.path() / "artifacts", kDefaultTenant, ArtifactLimits{})),
        artifacts_(*shelves_->of(kDefaultTenant)) {}

  std::string put(const std::string& content) {
    const std::string name = sha256_hex(content);
    auto upload = artifacts_->upload(name, static_cast<std::int64_t>(content.size()), 0);
    EXPECT_TRUE(upload.ok() && (*upload)->append(content).ok() && (*upload)->finish().ok());
    return name;
  }
  void submit(const std::string& job_id, const std::string& mesh) {
    Change job = example_job(job_id);
    job.record.job.mutable_spec()->set_mesh_sha256(mesh);
    ASSERT_TRUE(store_->create(job, 1000).ok());
  }
  // Not by stat(), which counts as use.
  bool there(const std::string& name) { return artifacts_->read(name).ok(); }

  // The files carry the real clock's times, so the cleaner's clock is that of some days later.
  Time days_later(int days) {
    return std::chrono::time_point_cast<Milliseconds>(std::chrono::system_clock::now()) + days * kDay;
  }

  TemporaryFolder folder_;
  std::unique_ptr<JobStore> store_;
  std::unique_ptr<TenantArtifacts> shelves_;
  ArtifactStore* artifacts_;
};

TEST_F(Retention, AnEndedJobIsKeptForItsTimeAndThenForgotten) {
  JobRetention duty(*store_, kDay, kHour);
  for (const char* id : {"ended", "queued"}) submit(id, std::string(64, '0'));
  ASSERT_TRUE(
      store_->modify("ended", [](const JobRecord& job) { return decide_cancel(job, kNoon, AttemptPolicy{}); })
          .ok());
  ASSERT_TRUE(duty.run_once(kNoon + kDay - Milliseconds(1)).ok());
  EXPECT_TRUE(store_->get("ended").ok());
  ASSERT_TRUE(duty.run_once(kNoon + kDay + kHour).ok());
  EXPECT_TRUE(absl::IsNotFound(store_->get("ended").status()));
  EXPECT_TRUE(store_->get("queued").ok());
}

TEST_F(Retention, ManyEndedJobsAreForgottenRoundAfterRound) {
  JobRetention duty(*store_, kDay, kHour);
  for (int i = 0; i < 250; ++i) {
    const std::string id = "job-" + std::to_string(i);
    submit(id, std::string(64, '0'));
    ASSERT_TRUE(
        store_->modify(id, [](const JobRecord& job) { return decide_cancel(job, kNoon, AttemptPolicy{}); })
            .ok());
  }
  for (int round = 0; round < 3; ++round) ASSERT_TRUE(duty.run_once(kNoon + kDay + kHour).ok());
  EXPECT_TRUE(store_->ended_jobs(kNoon + kDay, 10)->empty());
}

TEST_F(Retention, AnArtifactThatAJobRefersToStaysHoweverOldItIs) {
  ArtifactCleaner duty(*store_, *shelves_, kDay, kHour);
  const std::string mesh = put("mesh");
  const std::string result = put("result");
  const std::string nobodys = put("nobody's");
  submit("a", mesh);
  const auto job = store_->lease_next(
      kNoon, [](const JobRecord& record, std::int64_t token) { return leased(record, token, kNoon); });
  ASSERT_TRUE(job.ok() && job->has_value());
  auto done = completion("a", (*job)->lease.fencing_token, v1::JOB_STATE_SUCCEEDED);
  done.add_files()->set_sha256(result);
  ASSERT_TRUE(store_
                  ->modify("a",
                           [&](const JobRecord& record) {
                             return decide_complete(record, done, kNoon, AttemptPolicy());
                           })
                  .ok());
  ASSERT_TRUE(duty.run_once(days_later(2)).ok());
  EXPECT_TRUE(there(mesh));
  EXPECT_TRUE(there(result));
  EXPECT_FALSE(there(nobodys));
  ASSERT_TRUE(store_->remove("a", permit_delete).ok());
  ASSERT_TRUE(duty.run_once(days_later(3)).ok());
  EXPECT_FALSE(there(mesh));
  EXPECT_FALSE(there(result));
}

TEST_F(Retention, WhatWasUsedLatelyStaysAlsoWithoutAJob) {
  ArtifactCleaner duty(*store_, *shelves_, kDay, kHour);
  const std::string mesh = put("mesh");
  ASSERT_TRUE(duty.run_once(days_later(0) + kHour).ok());
  EXPECT_TRUE(there(mesh));
}

TEST_F(Retention, WhatIsAskedForBetweenTheLookAndTheRemovalStays) {
  const std::string mesh = put("mesh");
  const auto since = std::chrono::system_clock::now();
  ASSERT_EQ(artifacts_->unused_since(since)->size(), 1u);
  ASSERT_TRUE(artifacts_->stat(mesh).ok());  // a submission
  const auto removed = artifacts_->remove_unused(mesh, since);
  ASSERT_TRUE(removed.ok()) << removed.status();
  EXPECT_FALSE(*removed);
  EXPECT_TRUE(there(mesh));
}

TEST_F(Retention, AnAbandonedPartGoesAndOneThatIsBeingWrittenStays) {
  ArtifactCleaner duty(*store_, *shelves_, kDay, kHour);
  const std::string abandoned = sha256_hex("abandoned");
  {
    auto upload = artifacts_->upload(abandoned, 9, 0);
    ASSERT_TRUE(upload.ok() && (*upload)->append("aban").ok());
  }
  const std::string active = sha256_hex("active");
  auto upload = artifacts_->upload(active, 6, 0);
  ASSERT_TRUE(upload.ok() && (*upload)->append("act").ok());
  ASSERT_TRUE(duty.run_once(days_later(2)).ok());
  EXPECT_EQ(artifacts_->stat(abandoned)->resume_offset, 0);
  ASSERT_TRUE((*upload)->append("ive").ok());
  EXPECT_TRUE((*upload)->finish().ok());
  EXPECT_TRUE(there(active));
}

}  // namespace
}  // namespace skinframe::server
