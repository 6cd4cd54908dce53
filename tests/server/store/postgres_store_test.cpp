// SPDX-License-Identifier: Apache-2.0
// What is particular to PostgreSQL: several servers on one database, and a database that goes away.
#include "server/store/postgres_store.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "server/store/job_queries.h"
#include "server/store/postgres_migrations.h"
#include "server/store/postgres_news.h"
#include "server/store/postgres_session.h"
#include "tests/server/fixture/example_job.h"
#include "tests/server/store/store_factory.h"

namespace skinframe::server {
namespace {

constexpr std::int64_t kNoLimit = 1'000'000;
constexpr std::chrono::seconds kPatience{20};
const AttemptPolicy kPolicy;

// Remembers what it hears of other servers, and waits for it.
class Ear final : public CommitListener {
 public:
  void committed(const JobRecord& record, bool) override { add("own " + record.job.job_id()); }
  void removed(const std::string& job_id) override { add("own removed " + job_id); }
  void changed_elsewhere(const std::string& job_id, bool queued) override {
    add((queued ? "queued " : "changed ") + job_id);
  }
  void missed_news() override {
    const std::lock_guard lock(mutex_);
    ++connected_;
    heard_something_.notify_all();
  }

  bool hears(const std::string& what) {
    std::unique_lock lock(mutex_);
    return heard_something_.wait_for(lock, kPatience, [&] { return heard_.contains(what); });
  }
  bool is_connected(int times = 1) {
    std::unique_lock lock(mutex_);
    return heard_something_.wait_for(lock, kPatience, [&] { return connected_ >= times; });
  }
  std::set<std::string> heard() {
    const std::lock_guard lock(mutex_);
    return heard_;
  }

 private:
  void add(const std::string& what) {
    const std::lock_guard lock(mutex_);
    heard_.insert(what);
    heard_something_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable heard_something_;
  std::set<std::string> heard_;
  int connected_ = 0;
};

std::unique_ptr<JobStore> open_at(const std::string& where, CommitListener* listener = nullptr) {
  auto store = open_postgres_store({where, 8}, listener);
  EXPECT_TRUE(store.ok()) << store.status();
  return *std::move(store);
}

absl::StatusOr<std::optional<JobRecord>> lease(JobStore& store) {
  return store.lease_next(kNoon,
                          [](const JobRecord& job, std::int64_t token) { return leased(job, token, kNoon); });
}

std::string lines_of(PostgresStatement& statement) {
  std::string lines;
  while (statement.step()) lines += statement.bytes(0) + "\n";
  EXPECT_TRUE(statement.status().ok()) << statement.status();
  return lines;
}

TEST(PostgresStore, ALeaseWalksTheIndexAlsoWhenTheStatisticsKnowOfNoQueuedJob) {
  const std::string where = shared_postgres().new_database();
  open_at(where);
  const auto session = *PostgresSession::open(where);
  const auto add = [&](int first, int last, int state) {
    return session->execute(fmt::format(
        "INSERT INTO jobs (job_id, spec_digest, spec, profiles, priority, create_ms, state, reason, detail, "
        "results, attempt, lost_attempts, not_before_ms, cancel_requested, last_sequence, fencing_token, "
        "worker_id, instance_id, lease_expires_ms, completion_digest, rank_ms, tenant) "
        "SELECT 'j' || i, '', '', '', 0, i, {}, 0, '', '', 0, 0, 0, 0, 0, 0, '', '', 0, '', i, 't' || i % 10 "
        "FROM generate_series({}, {}) i",
        state, first, last));
  };
  ASSERT_TRUE(add(1, 5000, v1::JOB_STATE_SUCCEEDED).ok());
  ASSERT_TRUE(session->execute("ANALYZE jobs").ok());
  ASSERT_TRUE(add(5001, 25000, v1::JOB_STATE_QUEUED).ok());
  PostgresStatement explain(*session, "EXPLAIN " + first_queued_sql<PostgresSession>());
  const std::string plan = lines_of(explain.bind_text("t3").bind(std::int64_t{0}));
  EXPECT_NE(plan.find("Index Scan using jobs_queue"), std::string::npos) << plan;
  EXPECT_EQ(plan.find("Sort"), std::string::npos) << plan;
}

TEST(PostgresStore, AStatementThatMustSortIsNotCompiledForIt) {
  const std::string where = shared_postgres().new_database();
  open_at(where);
  const auto session = *PostgresSession::open(where);
  PostgresStatement explain(*session, "EXPLAIN ANALYZE SELECT job_id FROM jobs ORDER BY detail");
  const std::string plan = lines_of(explain);
  EXPECT_NE(plan.find("Sort"), std::string::npos) << plan;
  EXPECT_EQ(plan.find("JIT"), std::string::npos) << plan;
}

TEST(PostgresStore, AServerHearsOfChangesOfStateMadeThroughAnotherAndNotOfItsOwn) {
  const std::string where = shared_postgres().new_database();
  Ear here;
  Ear there;
  const auto one = open_at(where, &here);
  const auto other = open_at(where, &there);
  ASSERT_TRUE(here.is_connected() && there.is_connected());
  ASSERT_TRUE(one->create(example_job("a"), kNoLimit).ok());
  EXPECT_TRUE(there.hears("queued a"));
  const auto leased_there = lease(*other);
  ASSERT_TRUE(leased_there.ok() && leased_there->has_value());
  EXPECT_TRUE(here.hears("changed a"));
  // The removal is the last news: all that came before it has been heard by then.
  ASSERT_TRUE(
      other->modify("a", [](const JobRecord& job) { return decide_cancel(job, kNoon, AttemptPolicy{}); })
          .ok());
  EXPECT_FALSE(here.heard().contains("queued a"));
  EXPECT_FALSE(there.heard().contains("changed a"));
}

TEST(PostgresStore, ProgressIsNotToldFromServerToServerButItsNumberIsSeen) {
  const std::string where = shared_postgres().new_database();
  const auto one = open_at(where);
  const auto other = open_at(where);
  ASSERT_TRUE(one->create(example_job("a"), kNoLimit).ok());
  const auto job = lease(*one);
  ASSERT_TRUE(job.ok() && job->has_value());
  auto request = heartbeat("a", (*job)->lease.fencing_token);
  request.add_progress()->set_iteration(1);
  ASSERT_TRUE(
      one->modify("a",
                  [&](const JobRecord& record) { return decide_heartbeat(record, request, kNoon, kPolicy); })
          .ok());
  const auto last = other->last_sequences({"a", "none"});
  ASSERT_TRUE(last.ok()) << last.status();
  EXPECT_EQ(*last, (std::map<std::string, std::int64_t>{{"a", 3}}));
}

TEST(PostgresStore, TwoServersLeaseEachJobOnce) {
  const std::string where = shared_postgres().new_database();
  const auto one = open_at(where);
  const auto other = open_at(where);
  constexpr int kJobs = 40;
  for (int i = 0; i < kJobs; ++i)
    ASSERT_TRUE(one->create(example_job("job-" + std::to_string(i)), kNoLimit).ok());
  std::mutex mutex;
  std::multiset<std::string> ids;
  std::vector<std::thread> workers;
  for (JobStore* store : {one.get(), other.get(), one.get(), other.get()}) {
    workers.emplace_back([&, store] {
      for (auto job = lease(*store); job.ok() && job->has_value(); job = lease(*store)) {
        const std::lock_guard lock(mutex);
        ids.insert((*job)->job.job_id());
      }
    });
  }
  for (std::thread& worker : workers) worker.join();
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(kJobs));
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), static_cast<std::size_t>(kJobs));
}

TEST(PostgresStore, ServersThatStartTogetherMigrateOnce) {
  const std::string where = shared_postgres().new_database();
  std::vector<std::thread> servers;
  for (int i = 0; i < 6; ++i) {
    servers.emplace_back([&] {
      const auto store = open_postgres_store({where, 2}, nullptr);
      EXPECT_TRUE(store.ok()) << store.status();
    });
  }
  for (std::thread& server : servers) server.join();
  const auto session = PostgresSession::open(where);
  ASSERT_TRUE(session.ok());
  PostgresStatement count(**session, "SELECT count(*) FROM schema_version");
  ASSERT_TRUE(count.step()) << count.status();
  EXPECT_EQ(count.integer(0), static_cast<std::int64_t>(postgres_migrations().size()));
}

TEST(PostgresStore, AKilledDatabaseLosesNothingAndIsFoundAgain) {
  PostgresServer server;
  const std::string where = server.new_database();
  Ear ear;
  const auto store = open_at(where, &ear);
  ASSERT_TRUE(ear.is_connected());
  ASSERT_TRUE(store->create(example_job("before"), kNoLimit).ok());
  server.kill();
  // Submitted while the database is away: waits for it, or says UNAVAILABLE and is asked for again.
  Change during = example_job("during");
  during.record.request_id = "request";
  absl::StatusOr<Created> created = absl::UnavailableError("not tried");
  std::thread client([&] {
    const auto give_up = std::chrono::steady_clock::now() + kPatience;
    while (absl::IsUnavailable(created.status()) && std::chrono::steady_clock::now() < give_up)
      created = store->create(during, kNoLimit);
  });
  server.restart();
  client.join();
  ASSERT_TRUE(created.ok()) << created.status();
  EXPECT_TRUE(store->get("before").ok());
  EXPECT_TRUE(store->get("during").ok());
  EXPECT_TRUE(ear.is_connected(2));  // listens again, and says that news may have been missed
}

TEST(PostgresStore, ATextThatPostgresCannotHoldIsRefusedAndLeavesNothingBehind) {
  const auto store = open_at(shared_postgres().new_database());
  Change job = example_job("a");
  (*job.record.job.mutable_spec()->mutable_labels())["farm"] = std::string("no\0rth", 6);
  EXPECT_TRUE(absl::IsInvalidArgument(store->create(job, kNoLimit).status()));
  EXPECT_TRUE(absl::IsNotFound(store->get("a").status()));
}

TEST(PostgresStore, WhatCannotBeReachedIsUnavailable) {
  const auto store = open_postgres_store({"postgresql://postgres@127.0.0.1:1/none", 2}, nullptr);
  EXPECT_TRUE(absl::IsUnavailable(store.status())) << store.status();
}

TEST(PostgresNews, SurvivesItsWayAndRefusesWhatIsNotOurs) {
  for (const auto kind : {News::Kind::kQueued, News::Kind::kOtherState, News::Kind::kRemoved}) {
    News news;
    ASSERT_TRUE(decode(encode({"sender", kind, "job-1"}), news));
    EXPECT_EQ(news.sender, "sender");
    EXPECT_EQ(news.kind, kind);
    EXPECT_EQ(news.job_id, "job-1");
  }
  News news;
  for (const char* payload : {"", "x", "sender", "sender x job", "sender q", "sender qjob"})
    EXPECT_FALSE(decode(payload, news)) << payload;
}

TEST(PostgresSession, AddsNetworkLimitsUnlessTheyAreSet) {
  const std::string limited = with_network_limits("postgresql://host/db?connect_timeout=1");
  EXPECT_NE(limited.find("?connect_timeout=1&"), std::string::npos) << limited;
  EXPECT_EQ(limited.find("connect_timeout=5"), std::string::npos) << limited;
  EXPECT_NE(with_network_limits("postgresql://host/db").find("/db?connect_timeout=5&"), std::string::npos);
}

}  // namespace
}  // namespace skinframe::server
