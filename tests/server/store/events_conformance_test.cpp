// SPDX-License-Identifier: Apache-2.0
// Events: numbered without gap, read in pages, thinned, told to the listener.
#include <thread>

#include "tests/server/store/job_store_conformance.h"

namespace skinframe::server {
namespace {

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

}  // namespace
}  // namespace skinframe::server
