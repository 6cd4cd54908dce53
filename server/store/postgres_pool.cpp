// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres_pool.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace skinframe::server {
namespace {

using std::chrono::milliseconds;

// A restart of the database is over in a few seconds; callers retry what takes longer.
constexpr milliseconds kFirstBackoff{50};
constexpr milliseconds kLongestBackoff{1'000};
constexpr milliseconds kPatience{5'000};

}  // namespace

PostgresPool::PostgresPool(std::string where, int most_sessions)
    : where_(std::move(where)), most_sessions_(most_sessions) {}

PostgresPool::Loan::~Loan() {
  if (session_ != nullptr) pool_->give_back(std::move(session_));
}

void PostgresPool::give_back(std::unique_ptr<PostgresSession> session) {
  {
    const std::lock_guard lock(mutex_);
    --lent_;
    if (!session->broken()) {
      idle_.push_back(std::move(session));
    } else {
      idle_.clear();  // the database went away: those that lie here have lost it too
    }
  }
  returned_.notify_one();
}

absl::StatusOr<PostgresPool::Loan> PostgresPool::borrow() {
  {
    std::unique_lock lock(mutex_);
    returned_.wait(lock, [this] { return lent_ < most_sessions_; });
    ++lent_;
    if (!idle_.empty()) {
      Loan loan(*this, std::move(idle_.back()));
      idle_.pop_back();
      return loan;
    }
  }
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  for (milliseconds pause = kFirstBackoff;; pause = std::min(2 * pause, kLongestBackoff)) {
    auto session = PostgresSession::open(where_);
    if (session.ok()) return Loan(*this, *std::move(session));
    if (std::chrono::steady_clock::now() + pause > give_up) {
      spdlog::error("{}", std::string(session.status().message()));
      const std::lock_guard lock(mutex_);
      --lent_;
      returned_.notify_one();
      return absl::UnavailableError("the database cannot be reached");
    }
    std::this_thread::sleep_for(pause);
  }
}

absl::Status PostgresPool::transact(const std::function<absl::Status(PostgresSession&)>& work) {
  for (bool again = true;; again = false) {
    auto loan = borrow();
    if (!loan.ok()) return loan.status();
    PostgresSession& session = **loan;
    absl::Status status = session.execute("BEGIN");
    if (!status.ok() && session.broken() && again) continue;
    if (status.ok()) status = work(session);
    if (status.ok()) status = session.execute("COMMIT");
    if (!status.ok() && !session.broken())
      session.execute("ROLLBACK").IgnoreError();  // the first error counts
    return status;
  }
}

}  // namespace skinframe::server
