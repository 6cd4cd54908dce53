// SPDX-License-Identifier: Apache-2.0
// Sessions of one PostgreSQL database, lent one at a time. A session that breaks is dropped; where the
// database is out of reach a caller waits for it, with backoff, and then gets UNAVAILABLE.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/store/postgres_session.h"

namespace skinframe::server {

class PostgresPool {
 public:
  PostgresPool(std::string where, int most_sessions);

  // Gives its session back when it goes.
  class Loan {
   public:
    Loan(PostgresPool& pool, std::unique_ptr<PostgresSession> session)
        : pool_(&pool), session_(std::move(session)) {}
    ~Loan();
    Loan(Loan&&) noexcept = default;
    Loan& operator=(Loan&&) = delete;
    PostgresSession& operator*() { return *session_; }
    PostgresSession* operator->() { return session_.get(); }

   private:
    PostgresPool* pool_;
    std::unique_ptr<PostgresSession> session_;
  };

  absl::StatusOr<Loan> borrow();

  // Runs work within a transaction: all of it is kept or nothing. A session that was found broken before
  // anything was done is replaced once.
  absl::Status transact(const std::function<absl::Status(PostgresSession&)>& work);

  // Runs read, each statement of which sees what was committed before it.
  template <class Read>
  auto with(Read read) -> decltype(read(std::declval<PostgresSession&>())) {
    for (bool again = true;; again = false) {
      auto loan = borrow();
      if (!loan.ok()) return loan.status();
      auto result = read(**loan);
      if (!again || result.ok() || !(*loan)->broken()) return result;
    }
  }

 private:
  friend class Loan;
  void give_back(std::unique_ptr<PostgresSession> session);

  const std::string where_;
  const int most_sessions_;
  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<PostgresSession>> idle_;
  int lent_ = 0;
};

}  // namespace skinframe::server
