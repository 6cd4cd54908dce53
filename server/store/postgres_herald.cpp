// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres_herald.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace skinframe::server {
namespace {

constexpr std::chrono::milliseconds kPause{200};  // while the database is away
constexpr std::size_t kAtOnce = 200;

}  // namespace

PostgresHerald::PostgresHerald(std::string where) : where_(std::move(where)), thread_([this] { run(); }) {}

PostgresHerald::~PostgresHerald() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void PostgresHerald::tell(const News& news) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(encode(news));
    if (waiting_.size() > kMostWaiting) waiting_.pop_front();
  }
  changed_.notify_one();
}

void PostgresHerald::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(std::min(kAtOnce, waiting_.size()));
    const std::vector<std::string> payloads(waiting_.begin(), end);
    waiting_.erase(waiting_.begin(), end);
    lock.unlock();
    const bool sent = send(payloads);
    lock.lock();
    if (sent) continue;
    if (stopping_) return;
    waiting_.insert(waiting_.begin(), payloads.begin(), payloads.end());
    changed_.wait_for(lock, kPause, [this] { return stopping_; });
  }
}

bool PostgresHerald::send(const std::vector<std::string>& payloads) {
  absl::Status status;
  if (session_ == nullptr) {
    auto opened = PostgresSession::open(where_);
    status = opened.status();
    if (status.ok()) session_ = *std::move(opened);
    if (status.ok()) status = session_->execute("SET synchronous_commit = off");
  }
  if (status.ok()) status = session_->execute("BEGIN");
  for (const std::string& payload : payloads) {
    if (!status.ok()) break;
    PostgresStatement tell(*session_, "SELECT pg_notify(?, ?)");
    status = tell.bind_text(kNewsChannel).bind_text(payload).run();
  }
  if (status.ok()) status = session_->execute("COMMIT");
  if (!status.ok()) session_.reset();
  if (!status.ok() && reachable_)
    spdlog::warn("other servers are not told of changes until the database is back: {}",
                 std::string(status.message()));
  reachable_ = status.ok();
  return status.ok();
}

}  // namespace skinframe::server
