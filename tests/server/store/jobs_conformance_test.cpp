// SPDX-License-Identifier: Apache-2.0
// Jobs as they are made, found, listed, reused and forgotten.
#include <atomic>
#include <map>
#include <thread>

#include "tests/server/store/job_store_conformance.h"

namespace skinframe::server {
namespace {

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

INSTANTIATE_TEST_SUITE_P(Stores, JobStoreConformance, testing::ValuesIn(store_kinds()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace skinframe::server
