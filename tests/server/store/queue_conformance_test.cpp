// SPDX-License-Identifier: Apache-2.0
// The queue: its limits, whose turn it is, leases and their tokens, what is overdue.
#include <mutex>
#include <set>
#include <thread>

#include "tests/server/store/job_store_conformance.h"

namespace skinframe::server {
namespace {

TEST_P(JobStoreConformance, AFullQueueRefusesUntilAJobLeavesIt) {
  ASSERT_TRUE(store_->create(example_job("a"), 1).ok());
  EXPECT_TRUE(absl::IsResourceExhausted(store_->create(example_job("b"), 1).status()));
  ASSERT_TRUE(lease());
  EXPECT_TRUE(store_->create(example_job("b"), 1).ok());
}

TEST_P(JobStoreConformance, ATenantsQuotaRefusesIsNamedAndTouchesNoOther) {
  const auto create_of = [&](const std::string& id, const std::string& tenant) {
    Change job = example_job(id);
    job.record.job.set_tenant(tenant);
    return store_->create(job, {kNoLimit, 2}).status();
  };
  ASSERT_TRUE(create_of("a", "north").ok());
  ASSERT_TRUE(create_of("b", "north").ok());
  const absl::Status refused = create_of("c", "north");
  EXPECT_TRUE(absl::IsResourceExhausted(refused));
  EXPECT_NE(refused.message().find("north"), absl::string_view::npos) << refused;
  EXPECT_NE(refused.message().find("quota"), absl::string_view::npos) << refused;
  EXPECT_TRUE(create_of("c", "south").ok());
  ASSERT_TRUE(cancel("a").ok());
  EXPECT_TRUE(create_of("d", "north").ok());
}

TEST_P(JobStoreConformance, LeasesInTheOrderOfTenantsThatIsAskedFor) {
  for (const char* id : {"a1", "a2", "b1", "c1"}) {
    Change job = example_job(id);
    job.record.job.set_tenant(std::string(1, id[0]));
    ASSERT_TRUE(store_->create(job, kNoLimit).ok());
  }
  std::vector<TenantLoad> seen;
  const auto lease_of = [&](const std::vector<std::string>& order) {
    const auto job = store_->lease_next(
        kNoon,
        [&](const std::vector<TenantLoad>& waiting) {
          seen = waiting;
          return order;
        },
        [](const JobRecord& record, std::int64_t token) { return leased(record, token); });
    EXPECT_TRUE(job.ok()) << job.status();
    return job.ok() && *job ? (*job)->job.job_id() : "none";
  };
  EXPECT_EQ(lease_of({"c", "a", "b"}), "c1");
  EXPECT_EQ(lease_of({"c", "a", "b"}), "a1");
  EXPECT_EQ(lease_of({}), "none");
  ASSERT_EQ(seen.size(), 2u) << "c has nothing queued any more";
  EXPECT_EQ(seen[0].tenant, "a");
  EXPECT_EQ(seen[0].running, 1);
  EXPECT_EQ(seen[1].running, 0);
  EXPECT_EQ(lease_of({"b"}), "b1");
}

TEST_P(JobStoreConformance, WaitingOutweighsPriorityInTheEndButNotBefore) {
  const auto create_at = [&](const std::string& id, int priority, Milliseconds after) {
    ASSERT_TRUE(store_->create(example_job(id, priority, kNoon + after), kNoLimit).ok());
  };
  create_at("low", 0, Milliseconds(0));
  create_at("soon", 2, kPolicy.ageing);                        // one point ahead
  create_at("late", 2, 2 * kPolicy.ageing + Milliseconds(1));  // low has aged past it
  for (const char* expected : {"soon", "low", "late"}) EXPECT_EQ(lease()->job.job_id(), expected);
}

TEST_P(JobStoreConformance, LeasesByPriorityThenBySubmission) {
  create("low", -1);
  create("first");
  create("second");
  create("high", 7);
  EXPECT_EQ(*store_->queued_before("second"), 2);
  for (const char* expected : {"high", "first", "second", "low"}) {
    const auto job = lease();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->job.job_id(), expected);
  }
  EXPECT_FALSE(lease());
}

TEST_P(JobStoreConformance, AJobInBackoffIsPassedOverUntilItsTime) {
  create("a");
  const auto first = lease();
  ASSERT_TRUE(first);
  const Time expiry = kNoon + kPolicy.lease;
  ASSERT_TRUE(
      store_->modify("a", [&](const JobRecord& job) { return decide_lease_expired(job, expiry, kPolicy); })
          .ok());
  const Time not_before = store_->get("a")->not_before;
  EXPECT_FALSE(lease(not_before - Milliseconds(1)));
  EXPECT_TRUE(lease(not_before));
}

TEST_P(JobStoreConformance, FencingTokensRiseOverDeletionAndReopening) {
  create("a");
  const auto first = lease();
  ASSERT_TRUE(first);
  ASSERT_TRUE(store_
                  ->modify("a",
                           [&](const JobRecord& job) {
                             return decide_complete(
                                 job, completion("a", first->lease.fencing_token, v1::JOB_STATE_SUCCEEDED),
                                 kNoon, kPolicy);
                           })
                  .ok());
  ASSERT_TRUE(store_->remove("a", permit_delete).ok());
  reopen();
  create("a");
  const auto second = lease();
  ASSERT_TRUE(second);
  EXPECT_GT(second->lease.fencing_token, first->lease.fencing_token);
}

TEST_P(JobStoreConformance, ACheckpointOutlivesItsAttemptAndAStaleOneIsRefused) {
  create("a");
  const auto put = [&](std::int64_t token, const std::string& sha256) {
    v1::CheckpointRequest request;
    request.set_fencing_token(token);
    request.mutable_checkpoint()->set_sha256(sha256);
    return store_->modify("a", [&](const JobRecord& job) { return decide_checkpoint(job, request); })
        .status();
  };
  const auto first = lease();
  ASSERT_TRUE(put(first->lease.fencing_token, "one").ok());
  const Time expiry = kNoon + kPolicy.lease;
  ASSERT_TRUE(
      store_->modify("a", [&](const JobRecord& job) { return decide_lease_expired(job, expiry, kPolicy); })
          .ok());
  EXPECT_TRUE(absl::IsAborted(put(first->lease.fencing_token, "late")));
  reopen();
  const auto second = lease(store_->get("a")->not_before);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->job.checkpoint().sha256(), "one");
  EXPECT_EQ(second->job.checkpoint().attempt(), 1);
  EXPECT_TRUE(absl::IsAborted(put(first->lease.fencing_token, "late")));
  ASSERT_TRUE(put(second->lease.fencing_token, "two").ok());
  EXPECT_EQ(store_->get("a")->job.checkpoint().attempt(), 2);
  const auto page = store_->list({});
  EXPECT_EQ(page->entries.at(0).job.checkpoint().sha256(), "two") << "the cleaner reads what is listed";
  ASSERT_TRUE(store_
                  ->modify("a",
                           [&](const JobRecord& job) {
                             return decide_complete(
                                 job, completion("a", second->lease.fencing_token, v1::JOB_STATE_SUCCEEDED),
                                 kNoon, kPolicy);
                           })
                  .ok());
  EXPECT_FALSE(store_->get("a")->job.has_checkpoint());
  EXPECT_TRUE(absl::IsAborted(put(second->lease.fencing_token, "after the end")));
}

TEST_P(JobStoreConformance, ConcurrentLeasesNeverGiveOneJobTwice) {
  constexpr int kJobs = 40;
  for (int i = 0; i < kJobs; ++i) create("job-" + std::to_string(i));
  std::mutex mutex;
  std::set<std::string> ids;
  std::set<std::int64_t> tokens;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      while (const auto job = lease()) {
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(ids.insert(job->job.job_id()).second);
        EXPECT_TRUE(tokens.insert(job->lease.fencing_token).second);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(kJobs));
}

TEST_P(JobStoreConformance, ACompletionAndTheReaperAtTheSameMomentMoveTheJobOnce) {
  for (int round = 0; round < 20; ++round) {
    const std::string id = "job-" + std::to_string(round);
    create(id);
    const auto job = lease();
    ASSERT_TRUE(job);
    const Time expiry = kNoon + kPolicy.lease;
    const auto done = completion(id, job->lease.fencing_token, v1::JOB_STATE_SUCCEEDED);
    absl::Status completed, reaped;
    std::thread worker([&] {
      completed =
          store_->modify(id, [&](const JobRecord& r) { return decide_complete(r, done, expiry, kPolicy); })
              .status();
    });
    reaped = store_->modify(id, [&](const JobRecord& r) { return decide_lease_expired(r, expiry, kPolicy); })
                 .status();
    worker.join();
    EXPECT_TRUE(reaped.ok()) << reaped;
    const bool succeeded = store_->get(id)->job.state() == v1::JOB_STATE_SUCCEEDED;
    EXPECT_EQ(completed.ok(), succeeded) << completed;
    EXPECT_TRUE(succeeded || absl::IsAborted(completed)) << completed;
    EXPECT_EQ(store_->events(id, 0, 10)->size(), 3u) << "queued, running, and one of the two";
    EXPECT_TRUE(cancel(id).ok());  // out of the next round's way
  }
}

TEST_P(JobStoreConformance, AWorkerOfTheSameNameThatRestartsIsAnotherWorker) {
  create("a");
  const auto first = lease();
  ASSERT_TRUE(store_
                  ->modify("a",
                           [&](const JobRecord& job) {
                             return decide_lease_expired(job, kNoon + kPolicy.lease, kPolicy);
                           })
                  .ok());
  const auto second = lease(store_->get("a")->not_before);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->lease.worker_id, second->lease.worker_id);
  EXPECT_TRUE(absl::IsAborted(beat("a", first->lease.fencing_token, 1).status()));
  const auto late = completion("a", first->lease.fencing_token, v1::JOB_STATE_SUCCEEDED);
  EXPECT_TRUE(absl::IsAborted(
      store_->modify("a", [&](const JobRecord& job) { return decide_complete(job, late, kNoon, kPolicy); })
          .status()));
  EXPECT_TRUE(beat("a", second->lease.fencing_token, 1).ok());
}

TEST_P(JobStoreConformance, TellsWhatEachTenantHasThatHasNotEnded) {
  EXPECT_TRUE(store_->tenant_figures()->empty());
  const auto create_of = [&](const std::string& id, const std::string& tenant, Milliseconds after) {
    Change job = example_job(id, 0, kNoon + after);
    job.record.job.set_tenant(tenant);
    ASSERT_TRUE(store_->create(job, kNoLimit).ok());
  };
  create_of("a1", "a", Milliseconds(0));
  create_of("b1", "b", Milliseconds(5));
  create_of("b2", "b", Milliseconds(7));
  create_of("c1", "c", Milliseconds(9));
  ASSERT_EQ(lease()->job.job_id(), "a1");
  ASSERT_TRUE(cancel("c1").ok());
  const auto figures = store_->tenant_figures();
  ASSERT_TRUE(figures.ok()) << figures.status();
  ASSERT_EQ(figures->size(), 2u) << "c has nothing left";
  EXPECT_EQ((*figures)[0].tenant, "a");
  EXPECT_EQ((*figures)[0].queued, 0);
  EXPECT_EQ((*figures)[0].running, 1);
  EXPECT_FALSE((*figures)[0].oldest_queued);
  EXPECT_EQ((*figures)[1].queued, 2);
  EXPECT_EQ((*figures)[1].oldest_queued, kNoon + Milliseconds(5));
}

TEST_P(JobStoreConformance, FindsExpiredLeasesAndPassedDeadlinesOldestFirst) {
  for (const char* id : {"b", "a"}) {
    Change job = example_job(id);
    job.record.deadline = kNoon + Milliseconds(id[0] == 'a' ? 10 : 20);
    ASSERT_TRUE(store_->create(job, kNoLimit).ok());
  }
  EXPECT_TRUE(store_->passed_deadlines(kNoon + Milliseconds(9), 10)->empty());
  EXPECT_EQ(*store_->passed_deadlines(kNoon + Milliseconds(20), 10), (std::vector<std::string>{"a", "b"}));
  ASSERT_TRUE(lease());
  EXPECT_EQ(store_->passed_deadlines(kNoon + Milliseconds(20), 10)->size(),
            1u);  // running ones are the lease's
  EXPECT_TRUE(store_->expired_leases(kNoon + kPolicy.lease - Milliseconds(1), 10)->empty());
  EXPECT_EQ(*store_->expired_leases(kNoon + kPolicy.lease, 10), (std::vector<std::string>{"b"}));
}

}  // namespace
}  // namespace skinframe::server
