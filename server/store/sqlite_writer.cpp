// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite_writer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <utility>

namespace skinframe::server {

SqliteWriter::SqliteWriter(std::unique_ptr<SqliteDatabase> database, std::size_t largest_group)
    : database_(std::move(database)), largest_group_(largest_group), thread_([this] { run(); }) {}

SqliteWriter::~SqliteWriter() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_there_.notify_one();
  thread_.join();
}

absl::Status SqliteWriter::write(const Work& work, const Committed& committed) {
  Part part{&work, &committed, absl::OkStatus()};
  std::unique_lock lock(mutex_);
  if (stopping_) return absl::UnavailableError("the server stops");
  waiting_.push_back(&part);
  work_there_.notify_one();
  work_done_.wait(lock, [&part] { return part.done; });
  return part.status;
}

std::int64_t SqliteWriter::groups() const {
  const std::lock_guard lock(mutex_);
  return groups_;
}

void SqliteWriter::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    work_there_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto end =
        waiting_.begin() + static_cast<std::ptrdiff_t>(std::min(waiting_.size(), largest_group_));
    std::vector<Part*> group(waiting_.begin(), end);
    waiting_.erase(waiting_.begin(), end);
    lock.unlock();
    commit_group(group);
    lock.lock();
    ++groups_;
    for (Part* part : group) part->done = true;
    work_done_.notify_all();
  }
}

void SqliteWriter::commit_group(std::vector<Part*>& group) {
  const auto fail_all = [&group](const absl::Status& status) {
    for (Part* part : group) {
      if (part->status.ok()) part->status = status;
    }
  };
  if (absl::Status status = database_->execute("BEGIN IMMEDIATE"); !status.ok()) {
    spdlog::error("store: a transaction of {} writes could not begin: {}", group.size(),
                  std::string(status.message()));
    return fail_all(status);
  }
  absl::Status broken;  // the transaction as a whole, not one part
  for (Part* part : group) {
    broken = database_->execute("SAVEPOINT part");
    if (!broken.ok()) break;
    part->status = (*part->work)(*database_);
    if (!part->status.ok()) broken = database_->execute("ROLLBACK TO part");
    if (broken.ok()) broken = database_->execute("RELEASE part");
    if (!broken.ok()) break;
  }
  if (broken.ok()) broken = database_->execute("COMMIT");
  if (!broken.ok()) {
    spdlog::error("store: a transaction of {} writes was given up: {}", group.size(),
                  std::string(broken.message()));
    database_->execute("ROLLBACK").IgnoreError();  // a full disk may have rolled it back already
    if (broken.code() == absl::StatusCode::kResourceExhausted) return fail_all(broken);
    return fail_all(absl::UnavailableError("the transaction was given up: " + std::string(broken.message())));
  }
  for (const Part* part : group) {
    if (part->status.ok() && *part->committed) (*part->committed)();
  }
}

}  // namespace skinframe::server
