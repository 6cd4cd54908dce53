// SPDX-License-Identifier: Apache-2.0
// A store for the conformance suite: each implementation names itself here and passes the same tests.
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "server/store/job_store.h"
#include "tests/server/fixture/postgres_server.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {

// A place for one store's data, which can be opened again and again.
class StorePlace {
 public:
  virtual ~StorePlace() = default;
  virtual std::unique_ptr<JobStore> open(CommitListener* listener) = 0;
};

struct StoreKind {
  std::string name;
  std::function<std::unique_ptr<StorePlace>()> make_place;
};

inline void PrintTo(const StoreKind& kind, std::ostream* out) { *out << kind.name; }

std::vector<StoreKind> store_kinds();

// One for all tests of a program.
PostgresServer& shared_postgres();

}  // namespace skinframe::server
