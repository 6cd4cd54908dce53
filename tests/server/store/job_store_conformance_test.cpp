// SPDX-License-Identifier: Apache-2.0
// What every store guarantees (server/store/job_store.h), whatever it is built on.
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>

#include "tests/server/fixture/example_job.h"
#include "tests/server/store/store_factory.h"

namespace skinframe::server {
namespace {

constexpr std::int64_t kNoLimit = 1'000'000;
const AttemptPolicy kPolicy;

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

TEST_P(JobStoreConformance, WhatWasWrittenIsReadBackWholeAlsoAfterReopening) {
  Change job = example_job("a", 5);
  job.record.request_id = "request";
  job.record.deadline = kNoon + Milliseconds(1234);
  (*job.record.job.mutable_spec()->mutable_labels())["farm"] = "north";
  job.record.warm_start_files.emplace_back().set_path("p/initial-frame.json");
  const auto created = store_->create(job, kNoLimit);
  ASSERT_TRUE(created.ok()) << created.status();
  ASSERT_TRUE(lease());
  reopen();
  const auto record = store_->get("a");
  ASSERT_TRUE(record.ok()) << record.status();
  EXPECT_EQ(record->job.spec().SerializeAsString(), job.record.job.spec().SerializeAsString());
  EXPECT_EQ(record->job.state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(record->job.attempt(), 1);
  EXPECT_EQ(record->job.last_sequence(), 2);
  EXPECT_EQ(record->deadline, job.record.deadline);
  EXPECT_EQ(record->request_id, "request");
  EXPECT_EQ(record->lease.worker_id, "worker");
  EXPECT_EQ(record->lease.instance_id, "instance");
  EXPECT_EQ(record->lease.expires, kNoon + kPolicy.lease);
  ASSERT_EQ(record->printers.size(), 1u);
  EXPECT_EQ(record->materials.at(0).id(), "pa");
  ASSERT_EQ(record->warm_start_files.size(), 1u);
  EXPECT_EQ(record->warm_start_files[0].path(), "p/initial-frame.json");
}

TEST_P(JobStoreConformance, AnUnknownJobIsNotFound) {
  EXPECT_TRUE(absl::IsNotFound(store_->get("none").status()));
  EXPECT_TRUE(absl::IsNotFound(store_->events("none", 0, 10).status()));
  EXPECT_TRUE(absl::IsNotFound(store_->queued_before("none").status()));
  EXPECT_TRUE(absl::IsNotFound(cancel("none")));
  EXPECT_TRUE(absl::IsNotFound(store_->remove("none", permit_delete)));
}

TEST_P(JobStoreConformance, SameRequestAndSpecIsTheSameJobAnotherSpecIsRefused) {
  Change first = example_job("a");
  first.record.request_id = "r";
  ASSERT_TRUE(store_->create(first, kNoLimit).ok());
  Change again = example_job("b");
  again.record.request_id = "r";
  const auto same = store_->create(again, 0);  // a full queue is no obstacle to what is there already
  ASSERT_TRUE(same.ok()) << same.status();
  EXPECT_TRUE(same->existed);
  EXPECT_EQ(same->record.job.job_id(), "a");
  again.record.spec_digest = "another";
  EXPECT_TRUE(absl::IsAlreadyExists(store_->create(again, kNoLimit).status()));
  EXPECT_TRUE(absl::IsNotFound(store_->get("b").status()));
}

TEST_P(JobStoreConformance, ConcurrentSubmissionsOfOneRequestMakeOneJob) {
  std::atomic<int> made = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      Change job = example_job("job-" + std::to_string(i));
      job.record.request_id = "r";
      const auto created = store_->create(job, kNoLimit);
      ASSERT_TRUE(created.ok()) << created.status();
      if (!created->existed) ++made;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 1);
  EXPECT_EQ(listed({}).size(), 1u);
}

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

TEST_P(JobStoreConformance, RequestIdsAreTheTenantsOwn) {
  for (const char* tenant : {"default", "north"}) {
    Change job = example_job(std::string("of-") + tenant);
    job.record.request_id = "r";
    job.record.job.set_tenant(tenant);
    const auto created = store_->create(job, kNoLimit);
    ASSERT_TRUE(created.ok()) << created.status();
    EXPECT_FALSE(created->existed);
    EXPECT_EQ(store_->get(job.record.job.job_id())->request_id, "r");
    EXPECT_EQ(store_->get(job.record.job.job_id())->job.tenant(), tenant);
  }
  EXPECT_EQ(listed({.tenant = "north"}), (std::vector<std::string>{"of-north"}));
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

TEST_P(JobStoreConformance, ARefusedDecisionLeavesNothingBehind) {
  create("a");
  ASSERT_TRUE(lease());
  const std::string before = store_->get("a")->job.SerializeAsString();
  EXPECT_TRUE(absl::IsAborted(beat("a", 999, 3).status()));
  EXPECT_EQ(store_->get("a")->job.SerializeAsString(), before);
  EXPECT_EQ(store_->events("a", 0, 100)->size(), 2u);
}

TEST_P(JobStoreConformance, EventsAreNumberedWithoutGapUnderConcurrentWriters) {
  create("a");
  create("b");
  const auto first = lease();
  const auto second = lease();
  ASSERT_TRUE(first && second);
  std::vector<std::thread> threads;
  for (int i = 0; i < 6; ++i) {
    threads.emplace_back([&, i] {
      const JobRecord& job = i % 2 == 0 ? *first : *second;
      for (int n = 0; n < 10; ++n) EXPECT_TRUE(beat(job.job.job_id(), job.lease.fencing_token, 3).ok());
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const char* id : {"a", "b"}) {
    const auto events = store_->events(id, 0, 1000);
    ASSERT_TRUE(events.ok());
    ASSERT_EQ(events->size(), 92u);  // queued, running, 3 x 10 x 3 progress
    for (std::size_t i = 0; i < events->size(); ++i) {
      EXPECT_EQ((*events)[i].sequence(), static_cast<std::int64_t>(i) + 1);
      EXPECT_EQ((*events)[i].job_id(), id);
    }
    EXPECT_EQ(store_->get(id)->job.last_sequence(), 92);
  }
}

TEST_P(JobStoreConformance, EventsComeFromASequenceNumberInPages) {
  create("a");
  const auto job = lease();
  ASSERT_TRUE(beat("a", job->lease.fencing_token, 5).ok());  // events 3 .. 7
  const auto page = store_->events("a", 2, 3);
  ASSERT_EQ(page->size(), 3u);
  EXPECT_EQ(page->front().sequence(), 3);
  EXPECT_EQ(page->back().sequence(), 5);
  EXPECT_TRUE(store_->events("a", 7, 3)->empty());
}

TEST_P(JobStoreConformance, ListIsNewestFirstInPagesThatNeitherRepeatNorSkip) {
  for (int i = 0; i < 7; ++i) create("job-" + std::to_string(i));
  ListQuery query;
  query.limit = 3;
  std::vector<std::string> seen;
  for (bool more = true; more;) {
    const auto page = store_->list(query);
    ASSERT_TRUE(page.ok());
    if (seen.empty()) create("late");  // what comes meanwhile does not disturb the pages
    for (const auto& entry : page->entries) seen.push_back(entry.job.job_id());
    query.before_ordinal = page->entries.back().ordinal;
    more = page->more;
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"job-6", "job-5", "job-4", "job-3", "job-2", "job-1", "job-0"}));
}

TEST_P(JobStoreConformance, ListFiltersByStateAndByAllLabels) {
  const auto create_labelled = [&](const std::string& id, const std::map<std::string, std::string>& labels) {
    JobRecord record = example_record(id);
    record.job.mutable_spec()->mutable_labels()->insert(labels.begin(), labels.end());
    ASSERT_TRUE(store_->create(decide_submit(record, kNoon, kPolicy), kNoLimit).ok());
  };
  create_labelled("a", {{"farm", "north"}, {"user", "eva"}});
  create_labelled("b", {{"farm", "north"}});
  create_labelled("c", {{"farm", "south"}, {"user", "eva"}});
  ASSERT_TRUE(cancel("b").ok());
  EXPECT_EQ(listed({.labels = {{"farm", "north"}}}), (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(listed({.labels = {{"farm", "north"}, {"user", "eva"}}}), (std::vector<std::string>{"a"}));
  EXPECT_EQ(listed({.states = {v1::JOB_STATE_QUEUED}}), (std::vector<std::string>{"c", "a"}));
  EXPECT_EQ(
      listed({.states = {v1::JOB_STATE_QUEUED, v1::JOB_STATE_CANCELLED}, .labels = {{"farm", "north"}}}),
      (std::vector<std::string>{"b", "a"}));
}

TEST_P(JobStoreConformance, RemoveForgetsJobEventsAndRequestIdWhenPermitted) {
  Change job = example_job("a");
  job.record.request_id = "r";
  ASSERT_TRUE(store_->create(job, kNoLimit).ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(store_->remove("a", permit_delete)));
  ASSERT_TRUE(cancel("a").ok());
  ASSERT_TRUE(store_->remove("a", permit_delete).ok());
  EXPECT_TRUE(absl::IsNotFound(store_->get("a").status()));
  job.record.job.set_job_id("b");
  EXPECT_FALSE(store_->create(job, kNoLimit)->existed);
  EXPECT_EQ(store_->events("b", 0, 10)->size(), 1u);
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

TEST_P(JobStoreConformance, FindsEndedJobsByTheTimeTheyEnded) {
  for (const char* id : {"a", "b", "queued"}) create(id);
  ASSERT_TRUE(
      store_->modify("b", [](const JobRecord& job) { return decide_cancel(job, kNoon, AttemptPolicy{}); })
          .ok());
  ASSERT_TRUE(store_
                  ->modify("a",
                           [](const JobRecord& job) {
                             return decide_cancel(job, kNoon + Milliseconds(5), AttemptPolicy{});
                           })
                  .ok());
  EXPECT_TRUE(store_->ended_jobs(kNoon - Milliseconds(1), 10)->empty());
  EXPECT_EQ(*store_->ended_jobs(kNoon, 10), (std::vector<std::string>{"b"}));
  EXPECT_EQ(*store_->ended_jobs(kNoon + Milliseconds(5), 10), (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(*store_->ended_jobs(kNoon + Milliseconds(5), 1), (std::vector<std::string>{"b"}));
}

TEST_P(JobStoreConformance, FindsTheNewestWholeResultOfTheSameRequestOfTheSameTenant) {
  const auto ended = [&](const std::string& id, const std::string& tenant, v1::JobState state,
                         v1::Reason reason = v1::REASON_UNSPECIFIED) {
    Change job = example_job(id);
    job.record.reuse_key = "key";
    job.record.job.set_tenant(tenant);
    ASSERT_TRUE(store_->create(job, kNoLimit).ok());
    const auto token = lease()->lease.fencing_token;
    ASSERT_TRUE(store_
                    ->modify(id,
                             [&](const JobRecord& r) {
                               return decide_complete(r, completion(id, token, state, reason), kNoon,
                                                      kPolicy);
                             })
                    .ok());
  };
  const auto found = [&](const std::string& tenant, const std::string& key) {
    const auto job = store_->find_reusable(tenant, key);
    EXPECT_TRUE(job.ok()) << job.status();
    return job.ok() && *job ? (*job)->job.job_id() : "none";
  };
  ended("failed", "default", v1::JOB_STATE_FAILED, v1::REASON_INFEASIBLE);
  ended("partial", "default", v1::JOB_STATE_SUCCEEDED, v1::REASON_PARTIAL);
  EXPECT_EQ(found("default", "key"), "none");
  ended("first", "default", v1::JOB_STATE_SUCCEEDED);
  ended("second", "default", v1::JOB_STATE_SUCCEEDED);
  ended("theirs", "north", v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(found("default", "key"), "second");
  EXPECT_EQ(found("north", "key"), "theirs");
  EXPECT_EQ(found("default", "another key"), "none");
  Change reused = decide_reuse(example_record("reused"), *store_->get("second"), kNoon, kPolicy);
  ASSERT_TRUE(store_->create(reused, 0).ok()) << "a full queue is no obstacle to what is not queued";
  reopen();
  EXPECT_EQ(store_->get("reused")->job.reused_job_id(), "second");
  EXPECT_EQ(store_->get("reused")->job.state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_P(JobStoreConformance, ThinningTakesTheProgressOfEndedJobsAndNothingElse) {
  for (const char* id : {"ended", "running"}) create(id);
  const auto first = lease();
  const auto second = lease();
  ASSERT_TRUE(first && second);
  for (const auto& job : {*first, *second})
    ASSERT_TRUE(beat(job.job.job_id(), job.lease.fencing_token, 3).ok());  // events 3, 4, 5
  auto done = completion("ended", first->lease.fencing_token, v1::JOB_STATE_SUCCEEDED);
  done.add_printers()->set_printer_id("p");
  ASSERT_TRUE(
      store_->modify("ended", [&](const JobRecord& r) { return decide_complete(r, done, kNoon, kPolicy); })
          .ok());
  EXPECT_EQ(*store_->thin_progress(kNoon - Milliseconds(1), 10), 0);
  EXPECT_EQ(*store_->thin_progress(kNoon, 10), 1);
  EXPECT_EQ(*store_->thin_progress(kNoon, 10), 0) << "once is enough";
  std::vector<std::int64_t> left;
  const auto events = store_->events("ended", 0, 100);
  for (const v1::JobEvent& event : *events) left.push_back(event.sequence());
  EXPECT_EQ(left, (std::vector<std::int64_t>{1, 2, 6, 7}));
  EXPECT_EQ(store_->get("ended")->job.last_sequence(), 7);
  EXPECT_EQ(store_->events("running", 0, 100)->size(), 5u);
}

TEST_P(JobStoreConformance, TellsTheNewestSequenceOfManyJobsAtOnce) {
  std::vector<std::string> ids = {"none"};
  for (int i = 0; i < 3; ++i) {
    ids.push_back("job-" + std::to_string(i));
    create(ids.back());
  }
  for (int i = 0; i < 600; ++i)
    ids.push_back("unknown-" + std::to_string(i));  // more than one statement holds
  ASSERT_TRUE(lease());
  const auto last = store_->last_sequences(ids);
  ASSERT_TRUE(last.ok()) << last.status();
  EXPECT_EQ(*last, (std::map<std::string, std::int64_t>{{"job-0", 2}, {"job-1", 1}, {"job-2", 1}}));
  EXPECT_TRUE(store_->last_sequences({})->empty());
}

TEST_P(JobStoreConformance, TheListenerHearsOfEachCommitBeforeTheWriteReturnsAndOfNoRefusal) {
  struct Ear : CommitListener {
    std::vector<std::string> heard;
    void committed(const JobRecord& record, bool state_changed) override {
      heard.push_back(record.job.job_id() + (state_changed ? " state " : " event ") +
                      std::to_string(record.job.last_sequence()));
    }
    void removed(const std::string& job_id) override { heard.push_back(job_id + " removed"); }
  } ear;
  store_.reset();
  store_ = place_->open(&ear);
  create("a");
  EXPECT_EQ(ear.heard.size(), 1u);
  const auto job = lease();
  ASSERT_TRUE(beat("a", job->lease.fencing_token, 2).ok());
  EXPECT_FALSE(beat("a", 999, 2).ok());
  ASSERT_TRUE(store_
                  ->modify("a",
                           [&](const JobRecord& r) {
                             return decide_complete(
                                 r, completion("a", job->lease.fencing_token, v1::JOB_STATE_SUCCEEDED), kNoon,
                                 kPolicy);
                           })
                  .ok());
  ASSERT_TRUE(store_->remove("a", permit_delete).ok());
  EXPECT_EQ(ear.heard,
            (std::vector<std::string>{"a state 1", "a state 2", "a event 4", "a state 5", "a removed"}));
  store_.reset();  // before the ear
}

INSTANTIATE_TEST_SUITE_P(Stores, JobStoreConformance, testing::ValuesIn(store_kinds()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace skinframe::server
