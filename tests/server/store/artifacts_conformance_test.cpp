// SPDX-License-Identifier: Apache-2.0
// Which files stay and which go: what a job refers to stays, dropped checkpoints go, on every store.
#include <chrono>

#include "server/artifacts/upload.h"
#include "server/jobs/job_id.h"
#include "server/retention/artifact_cleaner.h"
#include "server/retention/checkpoint_cleaner.h"
#include "tests/server/store/job_store_conformance.h"

namespace skinframe::server {
namespace {

using std::chrono::seconds;

constexpr Milliseconds kEvery{10'000};
constexpr Milliseconds kGrace{60'000};

class ArtifactConformance : public JobStoreConformance {
 protected:
  void SetUp() override {
    JobStoreConformance::SetUp();
    shelves_ = *TenantArtifacts::open(folder_.path(), kDefaultTenant, ArtifactLimits{});
    artifacts_ = *shelves_->of(kDefaultTenant);
    cleaner_.emplace(*store_, *shelves_, kEvery, kGrace);
  }

  // The file, as one that nobody has used for an hour.
  std::string put(const std::string& content) {
    const std::string name = sha256_hex(content);
    auto upload = artifacts_->upload(name, static_cast<std::int64_t>(content.size()), 0);
    EXPECT_TRUE(upload.ok() && (*upload)->append(content).ok() && (*upload)->finish().ok());
    const auto file = folder_.path() / "complete" / name.substr(0, 2) / name;
    std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) - std::chrono::hours(1));
    return name;
  }
  bool there(const std::string& name) { return artifacts_->read(name).ok(); }  // stat() would count as use

  std::int64_t run(const std::string& job_id, const std::string& mesh = std::string(64, 'a')) {
    Change job = example_job(job_id);
    job.record.job.mutable_spec()->set_mesh_sha256(mesh);
    EXPECT_TRUE(store_->create(job, kNoLimit).ok());
    return lease()->lease.fencing_token;
  }
  void leave_checkpoint(const std::string& job_id, std::int64_t token, const std::string& sha256) {
    v1::CheckpointRequest request;
    request.set_fencing_token(token);
    request.mutable_checkpoint()->set_sha256(sha256);
    ASSERT_TRUE(
        store_->modify(job_id, [&](const JobRecord& job) { return decide_checkpoint(job, request); }).ok());
  }
  void end(const std::string& job_id, std::int64_t token, const std::string& result = "") {
    auto request = completion(job_id, token, v1::JOB_STATE_SUCCEEDED);
    if (!result.empty()) request.add_files()->set_sha256(result);
    ASSERT_TRUE(
        store_
            ->modify(job_id,
                     [&](const JobRecord& job) { return decide_complete(job, request, kNoon, kPolicy); })
            .ok());
  }
  std::vector<std::string> dropped() {
    std::vector<std::string> names;
    const auto rows = store_->dropped_checkpoints(100);
    EXPECT_TRUE(rows.ok()) << rows.status();
    for (const DroppedCheckpoint& row : *rows) names.push_back(row.tenant + " " + row.sha256);
    return names;
  }
  static Time real_now() {  // the files carry the real clock's times
    return std::chrono::time_point_cast<Milliseconds>(std::chrono::system_clock::now());
  }
  // All rounds of the cleaner that begin at a time.
  void clean(Time from) {
    for (const Milliseconds after : {Milliseconds(0), kGrace, kGrace + Milliseconds(100),
                                     kGrace + Milliseconds(200), kGrace + Milliseconds(300)})
      ASSERT_TRUE(cleaner_->run_once(from + after).ok());
  }

  TemporaryFolder folder_;
  std::unique_ptr<TenantArtifacts> shelves_;
  ArtifactStore* artifacts_ = nullptr;
  std::optional<CheckpointCleaner> cleaner_;
};

TEST_P(ArtifactConformance, DroppedOnesAreToldUntilTheyAreForgotten) {
  const std::int64_t token = run("a");
  leave_checkpoint("a", token, "one");
  EXPECT_TRUE(dropped().empty());
  leave_checkpoint("a", token, "two");
  EXPECT_EQ(dropped(), (std::vector<std::string>{"default one"}));
  end("a", token);
  reopen();
  EXPECT_EQ(dropped(), (std::vector<std::string>{"default one", "default two"}));
  const std::int64_t again = run("b");
  leave_checkpoint("b", again, "two");
  end("b", again);
  EXPECT_EQ(dropped().size(), 2u) << "the same is told once";
  ASSERT_TRUE(store_->forget_dropped({{"default", "one"}, {"north", "two"}}).ok());
  EXPECT_EQ(dropped(), (std::vector<std::string>{"default two"}));
}

TEST_P(ArtifactConformance, TheFilesGoWithTheEndOfTheirJobAndTheOlderOnesBefore) {
  const std::string first = put("first"), last = put("last");
  const std::int64_t token = run("a");
  leave_checkpoint("a", token, first);
  leave_checkpoint("a", token, last);
  const Time start = real_now();
  clean(start);
  EXPECT_FALSE(there(first));
  EXPECT_TRUE(there(last)) << "the next attempt may need it";
  end("a", token);
  clean(start + seconds(300));
  EXPECT_FALSE(there(last));
  EXPECT_TRUE(dropped().empty());
}

TEST_P(ArtifactConformance, NoneThatAJobRefersToGoes) {
  const std::string checkpoint = put("checkpoint"), result = put("result"), mesh = put("mesh");
  const std::int64_t a = run("a"), b = run("b"), c = run("c", mesh);
  for (const std::string& name : {checkpoint, result, mesh}) leave_checkpoint("a", a, name);
  leave_checkpoint("b", b, checkpoint);  // came to the same
  end("a", a, result);
  clean(real_now());
  for (const std::string& name : {checkpoint, result, mesh}) EXPECT_TRUE(there(name)) << name;
  end("b", b);
  end("c", c);
  clean(real_now() + seconds(300));
  EXPECT_FALSE(there(checkpoint));
  EXPECT_TRUE(there(mesh));
}

TEST_P(ArtifactConformance, OneThatIsAskedForSinceItWasListedStays) {
  const std::string checkpoint = put("checkpoint");
  const std::int64_t token = run("a");
  leave_checkpoint("a", token, checkpoint);
  end("a", token);
  const Time start = real_now() - seconds(1);  // the file system's clock is a coarse one
  ASSERT_TRUE(cleaner_->run_once(start).ok());
  ASSERT_TRUE(artifacts_->stat(checkpoint)->complete);  // another job's upload finds it there
  clean(start + kGrace);
  EXPECT_TRUE(there(checkpoint));
  EXPECT_TRUE(dropped().empty()) << "the artifact cleaner's from here on";
}

TEST_P(ArtifactConformance, NothingThatAnyJobRefersToIsCleanedAwayHoweverOld) {
  const std::string mesh = put("mesh"), result = put("result"), checkpoint = put("checkpoint");
  const std::string earlier = put("a file of a job that was deleted since"), nobodys = put("nobody's");
  end("ended", run("ended", mesh), result);
  leave_checkpoint("running", run("running"), checkpoint);
  Change queued = example_job("queued");
  queued.record.warm_start_files.emplace_back().set_sha256(earlier);
  ASSERT_TRUE(store_->create(queued, kNoLimit).ok());
  reopen();
  ArtifactCleaner cleaner(*store_, *shelves_, std::chrono::hours(24), std::chrono::hours(1));
  ASSERT_TRUE(cleaner.run_once(real_now() + std::chrono::hours(24 * 365)).ok());
  for (const std::string& name : {mesh, result, checkpoint, earlier}) EXPECT_TRUE(there(name)) << name;
  EXPECT_FALSE(there(nobodys));
  ASSERT_TRUE(cancel("queued").ok());
  ASSERT_TRUE(cleaner.run_once(real_now() + std::chrono::hours(24 * 366)).ok());
  EXPECT_FALSE(there(earlier)) << "nobody starts from it any more";
}

INSTANTIATE_TEST_SUITE_P(Stores, ArtifactConformance, testing::ValuesIn(store_kinds()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace skinframe::server
