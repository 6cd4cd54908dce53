// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite_store.h"

#include <fmt/format.h>

#include <utility>

#include "server/store/sqlite_migrations.h"
#include "server/store/sqlite_readers.h"
#include "server/store/sqlite_rows.h"
#include "server/store/sqlite_writer.h"

namespace skinframe::server {
namespace {

constexpr std::size_t kLargestGroup = 256;

class SqliteStore final : public JobStore {
 public:
  SqliteStore(std::unique_ptr<SqliteDatabase> database, const std::filesystem::path& file,
              CommitListener* listener)
      : writer_(std::move(database), kLargestGroup), readers_(file), listener_(listener) {}

  absl::StatusOr<Created> create(const Change& job, std::int64_t queue_limit) override {
    Created created;
    const auto work = [&](SqliteDatabase& database) {
      return create_in(database, job, queue_limit, created);
    };
    const auto tell = [&] {
      if (!created.existed) committed(created.record, true);
    };
    if (absl::Status status = writer_.write(work, tell); !status.ok()) return status;
    return created;
  }

  absl::StatusOr<JobRecord> modify(const std::string& job_id, const Decide& decide) override {
    JobRecord after;
    bool changed = false;
    bool state_changed = false;
    const auto work = [&](SqliteDatabase& database) -> absl::Status {
      auto row = find_job(database, job_id);
      if (!row.ok()) return row.status();
      auto change = decide(row->record);
      if (!change.ok()) return change.status();
      changed = change->has_value();
      if (!changed) {
        after = std::move(row->record);
        return absl::OkStatus();
      }
      after = std::move((*change)->record);
      state_changed = after.job.state() != row->record.job.state();
      return write_change(database, row->ordinal, after, std::move((*change)->events));
    };
    const auto tell = [&] {
      if (changed) committed(after, state_changed);
    };
    if (absl::Status status = writer_.write(work, tell); !status.ok()) return status;
    return after;
  }

  absl::StatusOr<std::optional<JobRecord>> lease_next(Time now, const DecideLease& decide) override {
    std::optional<JobRecord> leased;
    const auto work = [&](SqliteDatabase& database) -> absl::Status {
      auto row = first_queued(database, now);
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
    const auto work = [&](SqliteDatabase& database) -> absl::Status {
      const auto row = find_job(database, job_id);
      if (!row.ok()) return row.status();
      if (absl::Status status = permit(row->record); !status.ok()) return status;
      SqliteStatement erase(database, "DELETE FROM jobs WHERE ordinal = ?");  // labels and events go with it
      return erase.bind(row->ordinal).run();
    };
    const auto tell = [&] {
      if (listener_ != nullptr) listener_->removed(job_id);
    };
    return writer_.write(work, tell);
  }

  absl::StatusOr<JobRecord> get(const std::string& job_id) override {
    return readers_.with([&](SqliteDatabase& database) -> absl::StatusOr<JobRecord> {
      auto row = find_job(database, job_id);
      if (!row.ok()) return row.status();
      return std::move(row->record);
    });
  }

  absl::StatusOr<ListPage> list(const ListQuery& query) override {
    return readers_.with([&](SqliteDatabase& database) { return list_in(database, query); });
  }

  absl::StatusOr<std::vector<v1::JobEvent>> events(const std::string& job_id, std::int64_t after_sequence,
                                                   int limit) override {
    return readers_.with(
        [&](SqliteDatabase& database) { return events_in(database, job_id, after_sequence, limit); });
  }

  absl::StatusOr<std::int64_t> queued_before(const std::string& job_id) override {
    return readers_.with([&](SqliteDatabase& database) -> absl::StatusOr<std::int64_t> {
      SqliteStatement count(
          database,
          "SELECT (SELECT count(*) FROM jobs WHERE state = 1 AND (priority > own.priority OR "
          "(priority = own.priority AND ordinal < own.ordinal))) FROM jobs own WHERE job_id = ?");
      if (count.bind_text(job_id).step()) return count.integer(0);
      return count.status().ok() ? job_not_found(job_id) : count.status();
    });
  }

  absl::StatusOr<std::vector<std::string>> expired_leases(Time now, int limit) override {
    return ids(
        "SELECT job_id FROM jobs WHERE state = 2 AND lease_expires_ms <= ? ORDER BY lease_expires_ms LIMIT ?",
        now, limit);
  }

  absl::StatusOr<std::vector<std::string>> passed_deadlines(Time now, int limit) override {
    return ids("SELECT job_id FROM jobs WHERE state = 1 AND deadline_ms <= ? ORDER BY deadline_ms LIMIT ?",
               now, limit);
  }

 private:
  void committed(const JobRecord& record, bool state_changed) {
    if (listener_ != nullptr) listener_->committed(record, state_changed);
  }

  static absl::Status no_token(const absl::Status& status) {
    return status.ok() ? absl::InternalError("store: the fencing counter is gone: the file is damaged")
                       : status;
  }

  // Events first: they raise last_sequence, which the row then holds.
  static absl::Status write_change(SqliteDatabase& database, std::int64_t ordinal, JobRecord& record,
                                   std::vector<v1::JobEvent> events) {
    absl::Status status = append_events(database, ordinal, record, std::move(events));
    return status.ok() ? update_job(database, ordinal, record) : status;
  }

  static absl::Status create_in(SqliteDatabase& database, const Change& job, std::int64_t queue_limit,
                                Created& created) {
    const std::string& request_id = job.record.request_id;
    if (!request_id.empty()) {
      static const std::string kSql = fmt::format("SELECT {} FROM jobs WHERE request_id = ?", kJobColumns);
      SqliteStatement same(database, kSql);
      if (same.bind_text(request_id).step()) {
        auto row = read_row(same);
        if (!row.ok()) return row.status();
        if (row->record.spec_digest != job.record.spec_digest) {
          return absl::AlreadyExistsError(
              fmt::format("request_id \"{}\" was used with another spec, for job {}", request_id,
                          row->record.job.job_id()));
        }
        created = {std::move(row->record), true};
        return absl::OkStatus();
      }
      if (!same.status().ok()) return same.status();
    }
    SqliteStatement queued(database, "SELECT count(*) FROM jobs WHERE state = 1");
    if (!queued.step()) return queued.status();
    if (queued.integer(0) >= queue_limit) {
      return absl::ResourceExhaustedError(fmt::format("the queue is full: {} jobs wait", queued.integer(0)));
    }
    created.record = job.record;
    const auto ordinal = insert_job(database, created.record);
    if (!ordinal.ok()) return ordinal.status();
    return write_change(database, *ordinal, created.record, job.events);
  }

  static absl::StatusOr<std::optional<JobRow>> first_queued(SqliteDatabase& database, Time now) {
    static const std::string kSql = fmt::format(
        "SELECT {} FROM jobs WHERE state = 1 AND not_before_ms <= ? ORDER BY priority DESC, ordinal LIMIT 1",
        kJobColumns);
    SqliteStatement first(database, kSql);
    if (first.bind(now.time_since_epoch().count()).step()) {
      auto row = read_row(first);
      if (!row.ok()) return row.status();
      return *std::move(row);
    }
    if (!first.status().ok()) return first.status();
    return std::optional<JobRow>();
  }

  static absl::StatusOr<ListPage> list_in(SqliteDatabase& database, const ListQuery& query) {
    std::string sql = fmt::format("SELECT {} FROM jobs WHERE true", kJobColumns);
    if (query.before_ordinal > 0) sql += " AND ordinal < ?";
    for (std::size_t i = 0; i < query.states.size(); ++i) sql += i == 0 ? " AND state IN (?" : ", ?";
    if (!query.states.empty()) sql += ")";
    for (std::size_t i = 0; i < query.labels.size(); ++i) {
      sql +=
          " AND EXISTS (SELECT 1 FROM labels WHERE labels.ordinal = jobs.ordinal AND key = ? AND value = ?)";
    }
    sql += " ORDER BY ordinal DESC LIMIT ?";

    SqliteStatement select(database, sql);
    if (query.before_ordinal > 0) select.bind(query.before_ordinal);
    for (const v1::JobState state : query.states) select.bind(state);
    for (const auto& [key, value] : query.labels) select.bind_text(key).bind_text(value);
    select.bind(query.limit + 1);  // one more tells whether there is a further page
    ListPage page;
    while (select.step()) {
      if (static_cast<int>(page.entries.size()) == query.limit) {
        page.more = true;
        break;
      }
      auto row = read_row(select);
      if (!row.ok()) return row.status();
      page.entries.push_back({std::move(row->record.job), row->ordinal});
    }
    if (!select.status().ok()) return select.status();
    return page;
  }

  static absl::StatusOr<std::vector<v1::JobEvent>> events_in(SqliteDatabase& database,
                                                             const std::string& job_id,
                                                             std::int64_t after_sequence, int limit) {
    // The job itself comes along as a row without a body, so that an unknown job is told from one without
    // news.
    SqliteStatement select(
        database,
        "SELECT body FROM jobs LEFT JOIN events ON events.ordinal = jobs.ordinal AND sequence > ? "
        "WHERE job_id = ? ORDER BY sequence LIMIT ?");
    select.bind(after_sequence).bind_text(job_id).bind(limit);
    std::vector<v1::JobEvent> events;
    bool job_there = false;
    while (select.step()) {
      job_there = true;
      if (select.is_null(0)) break;
      if (!events.emplace_back().ParseFromString(select.bytes(0))) {
        return absl::InternalError(fmt::format("store: an event of job {} does not parse: damaged", job_id));
      }
    }
    if (!select.status().ok()) return select.status();
    if (!job_there) return job_not_found(job_id);
    return events;
  }

  absl::StatusOr<std::vector<std::string>> ids(const char* sql, Time now, int limit) {
    return readers_.with([&](SqliteDatabase& database) -> absl::StatusOr<std::vector<std::string>> {
      SqliteStatement select(database, sql);
      select.bind(now.time_since_epoch().count()).bind(limit);
      std::vector<std::string> found;
      while (select.step()) found.push_back(select.bytes(0));
      if (!select.status().ok()) return select.status();
      return found;
    });
  }

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
