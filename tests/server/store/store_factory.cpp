// SPDX-License-Identifier: Apache-2.0
#include "tests/server/store/store_factory.h"

#include <gtest/gtest.h>

#include "server/store/postgres_store.h"
#include "server/store/sqlite_store.h"
#include "tests/server/fixture/postgres_server.h"

namespace skinframe::server {
namespace {

std::unique_ptr<JobStore> opened(absl::StatusOr<std::unique_ptr<JobStore>> store) {
  EXPECT_TRUE(store.ok()) << store.status();
  return store.ok() ? *std::move(store) : nullptr;
}

class SqlitePlace final : public StorePlace {
 public:
  std::unique_ptr<JobStore> open(CommitListener* listener) override {
    return opened(open_sqlite_store(folder_.path() / "jobs.sqlite", listener));
  }

 private:
  TemporaryFolder folder_;
};

class PostgresPlace final : public StorePlace {
 public:
  PostgresPlace() : options_{shared_postgres().new_database(), 8} {}
  std::unique_ptr<JobStore> open(CommitListener* listener) override {
    return opened(open_postgres_store(options_, listener));
  }

 private:
  const PostgresOptions options_;
};

}  // namespace

PostgresServer& shared_postgres() {
  static PostgresServer server;
  return server;
}

std::vector<StoreKind> store_kinds() {
  return {{"Sqlite", [] { return std::make_unique<SqlitePlace>(); }},
          {"Postgres", [] { return std::make_unique<PostgresPlace>(); }}};
}

}  // namespace skinframe::server
