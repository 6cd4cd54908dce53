// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite_store.h"

#include <utility>

#include "server/store/sql_reads.h"
#include "server/store/sqlite_migrations.h"
#include "server/store/sqlite_readers.h"
#include "server/store/sqlite_writer.h"

namespace skinframe::server {
namespace {

constexpr std::size_t kLargestGroup = 256;

class SqliteStore final : public SqlReads<SqliteDatabase, SqliteReaders> {
 public:
  SqliteStore(std::unique_ptr<SqliteDatabase> database, const std::filesystem::path& file,
              CommitListener* listener)
      : writer_(std::move(database), kLargestGroup), readers_(file), listener_(listener) {}

  absl::StatusOr<Created> create(const Change& job, const QueueLimits& limits) override {
    Created created;
    const auto work = [&](SqliteDatabase& database) -> absl::Status {
      auto made = create_job(database, job, limits, counts_);
      if (!made.ok()) return made.status();
      created = *std::move(made);
      return absl::OkStatus();
    };
    const auto tell = [&] {
      if (!created.existed) committed(created.record, true);
    };
    if (absl::Status status = writer_.write(work, tell); !status.ok()) return status;
    return created;
  }

  absl::StatusOr<JobRecord> modify(const std::string& job_id, const Decide& decide) override {
    Modified modified;
    const auto work = [&](SqliteDatabase& database) -> absl::Status {
      auto made = modify_job(database, job_id, decide);
      if (made.ok()) modified = *std::move(made);
      return made.status();
    };
    const auto tell = [&] {
      if (modified.changed) committed(modified.after, modified.state_changed);
    };
    if (absl::Status status = writer_.write(work, tell); !status.ok()) return status;
    return modified.after;
  }

  absl::StatusOr<std::optional<JobRecord>> lease_next(Time now, const OrderTenants& order,
                                                      const DecideLease& decide) override {
    std::optional<JobRecord> leased;
    const auto work = [&](SqliteDatabase& database) -> absl::Status {
      auto row = first_in_order(database, now, order);
      if (!row.ok()) return row.status();
      if (!row->has_value()) return absl::OkStatus();
      SqliteStatement next_token(
          database, "UPDATE counters SET value = value + 1 WHERE name = 'fencing_token' RETURNING value");
      if (!next_token.step()) return no_token(next_token.status());
      const std::int64_t token = next_token.integer(0);
      if (absl::Status status = next_token.run(); !status.ok()) return status;
      Change change = decide((*row)->record, token);
      leased = std::move(change.record);
      return write_change(database, (*row)->ordinal, *leased, std::move(change.events));
    };
    const auto tell = [&] {
      if (leased) committed(*leased, true);
    };
    if (absl::Status status = writer_.write(work, tell); !status.ok()) return status;
    return leased;
  }

  absl::Status remove(const std::string& job_id, const Permit& permit) override {
    const auto work = [&](SqliteDatabase& database) { return erase_job(database, job_id, permit); };
    const auto tell = [&] {
      if (listener_ != nullptr) listener_->removed(job_id);
    };
    return writer_.write(work, tell);
  }

  absl::StatusOr<int> thin_progress(Time until, int most_jobs) override {
    int thinned = 0;
    const auto work = [&](SqliteDatabase& database) -> absl::Status {
      const auto jobs = thin_ended_jobs(database, until, most_jobs);
      if (jobs.ok()) thinned = *jobs;
      return jobs.status();
    };
    if (absl::Status status = writer_.write(work, [] {}); !status.ok()) return status;
    return thinned;
  }

  absl::Status forget_dropped(const std::vector<DroppedCheckpoint>& seen_to) override {
    return writer_.write([&](SqliteDatabase& database) { return forget_dropped_rows(database, seen_to); },
                         [] {});
  }

 private:
  SqliteReaders& source() override { return readers_; }

  void committed(const JobRecord& record, bool state_changed) {
    if (listener_ != nullptr) listener_->committed(record, state_changed);
  }

  static absl::Status no_token(const absl::Status& status) {
    return status.ok() ? absl::InternalError("store: the fencing counter is gone: the file is damaged")
                       : status;
  }

  QueueCounts counts_{/*others_write=*/false};
  SqliteWriter writer_;
  SqliteReaders readers_;
  CommitListener* const listener_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<JobStore>> open_sqlite_store(const std::filesystem::path& file,
                                                            CommitListener* listener) {
  auto database = SqliteDatabase::open(file, SqliteDatabase::Mode::kReadWrite);
  if (!database.ok()) return database.status();
  if (absl::Status status = migrate(**database, sqlite_migrations()); !status.ok()) return status;
  return std::make_unique<SqliteStore>(*std::move(database), file, listener);
}

}  // namespace skinframe::server
