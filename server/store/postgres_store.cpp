// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres_store.h"

#include <fmt/format.h>

#include <optional>
#include <random>
#include <utility>

#include "server/store/postgres_herald.h"
#include "server/store/postgres_migrations.h"
#include "server/store/postgres_news.h"
#include "server/store/postgres_pool.h"
#include "server/store/sql_reads.h"

namespace skinframe::server {
namespace {

// A row that was taken while a lease looked at it counts as seen, and the lease finds nothing: then it looks
// again.
constexpr int kLeaseTries = 4;

std::string sender_name() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

class PostgresStore final : public SqlReads<PostgresSession, PostgresPool> {
 public:
  PostgresStore(const PostgresOptions& options, CommitListener* listener)
      : pool_(options.where, options.most_sessions),
        listener_(listener),
        own_(sender_name()),
        herald_(options.where) {
    if (listener_ != nullptr) news_.emplace(options.where, own_, *listener_);
  }

  absl::StatusOr<Created> create(const Change& job, const QueueLimits& limits) override {
    Created created;
    const absl::Status status = pool_.transact([&](PostgresSession& session) -> absl::Status {
      auto made = create_job(session, job, limits, counts_);
      if (!made.ok()) return made.status();
      created = *std::move(made);
      return absl::OkStatus();
    });
    if (!status.ok()) return status;
    if (!created.existed) committed(created.record, true);
    return created;
  }

  absl::StatusOr<JobRecord> modify(const std::string& job_id, const Decide& decide) override {
    Modified modified;
    const absl::Status status = pool_.transact([&](PostgresSession& session) -> absl::Status {
      auto made = modify_job(session, job_id, decide);
      if (made.ok()) modified = *std::move(made);
      return made.status();
    });
    if (!status.ok()) return status;
    if (modified.changed) committed(modified.after, modified.state_changed);
    return modified.after;
  }

  absl::StatusOr<std::optional<JobRecord>> lease_next(Time now, const OrderTenants& order,
                                                      const DecideLease& decide) override {
    for (int attempt = 1;; ++attempt) {
      std::optional<JobRecord> leased;
      std::vector<std::string> asked;
      const absl::Status status = pool_.transact(
          [&](PostgresSession& session) { return lease_within(session, now, order, decide, leased, asked); });
      if (!status.ok()) return status;
      if (leased) committed(*leased, true);
      if (leased || attempt == kLeaseTries) return leased;
      const auto more = pool_.with([&](PostgresSession& session) { return any_queued(session, asked, now); });
      if (!more.ok()) return more.status();
      if (!*more) return leased;
    }
  }

  absl::Status remove(const std::string& job_id, const Permit& permit) override {
    const absl::Status status =
        pool_.transact([&](PostgresSession& session) { return erase_job(session, job_id, permit); });
    if (!status.ok()) return status;
    if (listener_ != nullptr) listener_->removed(job_id);
    herald_.tell({own_, News::Kind::kRemoved, job_id});
    return status;
  }

  absl::StatusOr<int> thin_progress(Time until, int most_jobs) override {
    int thinned = 0;
    const absl::Status status = pool_.transact([&](PostgresSession& session) -> absl::Status {
      const auto jobs = thin_ended_jobs(session, until, most_jobs);
      if (jobs.ok()) thinned = *jobs;
      return jobs.status();
    });
    if (!status.ok()) return status;
    return thinned;
  }

  absl::Status forget_dropped(const std::vector<DroppedCheckpoint>& seen_to) override {
    return pool_.transact([&](PostgresSession& session) { return forget_dropped_rows(session, seen_to); });
  }

 private:
  PostgresPool& source() override { return pool_; }

  void committed(const JobRecord& record, bool state_changed) {
    if (listener_ != nullptr) listener_->committed(record, state_changed);
    if (!state_changed) return;
    const bool queued = record.job.state() == v1::JOB_STATE_QUEUED;
    herald_.tell({own_, queued ? News::Kind::kQueued : News::Kind::kOtherState, record.job.job_id()});
  }

  absl::Status lease_within(PostgresSession& session, Time now, const OrderTenants& order,
                            const DecideLease& decide, std::optional<JobRecord>& leased,
                            std::vector<std::string>& asked) const {
    auto row = first_in_order(session, now, order, &asked);
    if (!row.ok()) return row.status();
    if (!row->has_value()) return absl::OkStatus();
    // A sequence never gives a number twice, also when the transaction is rolled back.
    PostgresStatement next_token(session, "SELECT nextval('fencing_tokens')");
    if (!next_token.step())
      return next_token.status().ok() ? absl::InternalError("store: no fencing token") : next_token.status();
    Change change = decide((*row)->record, next_token.integer(0));
    leased = std::move(change.record);
    return write_change(session, (*row)->ordinal, *leased, std::move(change.events));
  }

  static absl::StatusOr<bool> any_queued(PostgresSession& session, const std::vector<std::string>& tenants,
                                         Time now) {
    for (const std::string& tenant : tenants) {
      PostgresStatement some(
          session, "SELECT 1 FROM jobs WHERE state = 1 AND tenant = ? AND not_before_ms <= ? LIMIT 1");
      const bool there = some.bind_text(tenant).bind(to_ms(now)).step();
      if (!some.status().ok()) return some.status();
      if (there) return true;
    }
    return false;
  }

  QueueCounts counts_{/*others_write=*/true};
  PostgresPool pool_;
  CommitListener* const listener_;
  const std::string own_;
  PostgresHerald herald_;
  std::optional<PostgresNews> news_;  // last: it stops before what it uses goes
};

}  // namespace

absl::StatusOr<std::unique_ptr<JobStore>> open_postgres_store(const PostgresOptions& options,
                                                              CommitListener* listener) {
  auto session = PostgresSession::open(options.where);
  if (!session.ok()) return session.status();
  if (absl::Status status = migrate(**session, postgres_migrations()); !status.ok()) return status;
  return std::make_unique<PostgresStore>(options, listener);
}

}  // namespace skinframe::server
