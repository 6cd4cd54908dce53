// SPDX-License-Identifier: Apache-2.0
// What is particular to SQLite: its file, its migrations, its group commit.
#include "server/store/sqlite_store.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "server/store/sqlite_migrations.h"
#include "server/store/sqlite_writer.h"
#include "tests/server/fixture/example_job.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

std::unique_ptr<SqliteDatabase> open_database(const std::filesystem::path& file) {
  auto database = SqliteDatabase::open(file, SqliteDatabase::Mode::kReadWrite);
  EXPECT_TRUE(database.ok()) << database.status();
  return *std::move(database);
}

std::int64_t integer_of(SqliteDatabase& database, const char* sql) {
  SqliteStatement select(database, sql);
  EXPECT_TRUE(select.step()) << select.status();
  return select.integer(0);
}

TEST(SqliteDatabase, CommitsWaitForTheDisk) {
  TemporaryFolder folder;
  const auto database = open_database(folder.path() / "db");
  EXPECT_EQ(integer_of(*database, "PRAGMA synchronous"), 2);  // FULL
  SqliteStatement mode(*database, "PRAGMA journal_mode");
  ASSERT_TRUE(mode.step());
  EXPECT_EQ(mode.bytes(0), "wal");
}

TEST(Migrations, BringAnEmptyFileToTheNewestVersionAndAreNotAppliedTwice) {
  TemporaryFolder folder;
  const auto database = open_database(folder.path() / "db");
  ASSERT_TRUE(migrate(*database, sqlite_migrations()).ok());
  ASSERT_TRUE(migrate(*database, sqlite_migrations()).ok());
  EXPECT_EQ(integer_of(*database, "SELECT count(*) FROM schema_version"),
            static_cast<std::int64_t>(sqlite_migrations().size()));
}

TEST(Migrations, AreNumberedFromOneWithoutGap) {
  int expected = 1;
  for (const Migration& step : sqlite_migrations()) EXPECT_EQ(step.version, expected++);
}

// A store as servers without tenants wrote it.
TEST(Migrations, JobsOfBeforeTenantsAreTheDefaultTenantsInTheirOldOrder) {
  TemporaryFolder folder;
  const auto file = folder.path() / "db";
  {
    const auto database = open_database(file);
    ASSERT_TRUE(migrate(*database, sqlite_migrations().first(2)).ok());
    for (const auto& [id, priority] : {std::pair("low", 0), std::pair("high", 5)}) {
      const JobRecord record = example_record(id, priority);
      SqliteStatement insert(
          *database,
          "INSERT INTO jobs VALUES (NULL, ?, ?, '', ?, ?, ?, 1700000000000, NULL, 1, 0, '', x'', NULL, NULL, "
          "0, 0, 0, 0, 0, 0, '', '', 0, '')");
      insert.bind_text(id).bind_text(id).bind_blob(record.job.spec().SerializeAsString());
      ASSERT_TRUE(insert.bind_blob("").bind(priority).run().ok());
    }
  }
  auto store = open_sqlite_store(file, nullptr);
  ASSERT_TRUE(store.ok()) << store.status();
  EXPECT_EQ((*store)->get("low")->job.tenant(), "default");
  EXPECT_EQ((*store)->get("low")->request_id, "low");
  for (const char* expected : {"high", "low"}) {
    const auto next = (*store)->lease_next(
        kNoon, [](const JobRecord& job, std::int64_t token) { return leased(job, token); });
    ASSERT_TRUE(next.ok() && next->has_value()) << next.status();
    EXPECT_EQ((*next)->job.job_id(), expected);
  }
}

TEST(Migrations, ContinueFromTheVersionThatIsThere) {
  TemporaryFolder folder;
  const auto database = open_database(folder.path() / "db");
  const Migration steps[] = {{1, "one", "CREATE TABLE one (x INTEGER)"},
                             {2, "two", "CREATE TABLE two (x INTEGER)"}};
  ASSERT_TRUE(migrate(*database, std::span(steps, 1)).ok());
  ASSERT_TRUE(migrate(*database, steps).ok());
  EXPECT_EQ(integer_of(*database, "SELECT count(*) FROM one, two"), 0);
}

TEST(Migrations, AFailedStepLeavesNothingBehind) {
  TemporaryFolder folder;
  const auto database = open_database(folder.path() / "db");
  const Migration broken[] = {{1, "broken", "CREATE TABLE one (x INTEGER); CREATE TABEL two"}};
  EXPECT_FALSE(migrate(*database, broken).ok());
  EXPECT_EQ(integer_of(*database, "SELECT count(*) FROM sqlite_master WHERE name = 'one'"), 0);
}

TEST(Migrations, AStoreOfANewerServerIsRefused) {
  TemporaryFolder folder;
  const auto database = open_database(folder.path() / "db");
  const Migration newer[] = {{1, "one", "SELECT 1"}, {99, "future", "SELECT 1"}};
  ASSERT_TRUE(migrate(*database, newer).ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(migrate(*database, sqlite_migrations())));
}

TEST(SqliteWriter, WhatWaitsTogetherIsCommittedTogetherAndAFailingPartHarmsNobody) {
  TemporaryFolder folder;
  auto database = open_database(folder.path() / "db");
  ASSERT_TRUE(database->execute("CREATE TABLE t (x INTEGER UNIQUE)").ok());
  SqliteWriter writer(std::move(database), 256);
  constexpr int kThreads = 32;
  // The first part holds the writer until all others wait: they must share one commit.
  std::atomic<int> waiting = 0;
  const SqliteWriter::Work hold = [&](SqliteDatabase&) {
    while (waiting < kThreads) std::this_thread::yield();
    return absl::OkStatus();
  };
  std::thread first([&] { EXPECT_TRUE(writer.write(hold, [] {}).ok()); });
  std::atomic<int> failed = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      const SqliteWriter::Work insert = [i](SqliteDatabase& db) {
        SqliteStatement statement(db, "INSERT INTO t (x) VALUES (?)");
        return statement.bind(i % 2 == 0 ? i : -1).run();  // all odd ones but the first collide
      };
      ++waiting;
      if (!writer.write(insert, [] {}).ok()) ++failed;
    });
  }
  first.join();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failed, kThreads / 2 - 1);
  EXPECT_LT(writer.groups(), kThreads);
  const auto reader = open_database(folder.path() / "db");
  EXPECT_EQ(integer_of(*reader, "SELECT count(*) FROM t"), kThreads / 2 + 1);
}

}  // namespace
}  // namespace skinframe::server
