// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite_migrations.h"

#include <array>

#include "server/store/common_migrations.h"

namespace skinframe::server {
namespace {

// Times are milliseconds since 1970. State numbers are those of v1::JobState: 1 queued, 2 running.
constexpr char kJobsAndEvents[] = R"sql(
CREATE TABLE jobs (
  ordinal           INTEGER PRIMARY KEY AUTOINCREMENT,  -- order of submission, never used again
  job_id            TEXT    NOT NULL UNIQUE,
  request_id        TEXT    UNIQUE,                     -- NULL: the client gave none
  spec_digest       TEXT    NOT NULL,
  spec              BLOB    NOT NULL,                   -- v1.JobSpec
  profiles          BLOB    NOT NULL,                   -- v1.Assignment with printers and materials alone
  priority          INTEGER NOT NULL,
  create_ms         INTEGER NOT NULL,
  deadline_ms       INTEGER,
  state             INTEGER NOT NULL,
  reason            INTEGER NOT NULL,
  detail            TEXT    NOT NULL,
  results           BLOB    NOT NULL,                   -- v1.Job with printers and files alone
  start_ms          INTEGER,
  end_ms            INTEGER,
  attempt           INTEGER NOT NULL,
  lost_attempts     INTEGER NOT NULL,
  not_before_ms     INTEGER NOT NULL,
  cancel_requested  INTEGER NOT NULL,
  last_sequence     INTEGER NOT NULL,
  fencing_token     INTEGER NOT NULL,
  worker_id         TEXT    NOT NULL,
  instance_id       TEXT    NOT NULL,
  lease_expires_ms  INTEGER NOT NULL,
  completion_digest TEXT    NOT NULL
) STRICT;
CREATE INDEX jobs_queue    ON jobs (priority DESC, ordinal) WHERE state = 1;
CREATE INDEX jobs_deadline ON jobs (deadline_ms) WHERE state = 1 AND deadline_ms IS NOT NULL;
CREATE INDEX jobs_lease    ON jobs (lease_expires_ms) WHERE state = 2;
CREATE INDEX jobs_state    ON jobs (state, ordinal);

CREATE TABLE labels (
  ordinal INTEGER NOT NULL REFERENCES jobs (ordinal) ON DELETE CASCADE,
  key     TEXT    NOT NULL,
  value   TEXT    NOT NULL,
  PRIMARY KEY (ordinal, key)
) STRICT, WITHOUT ROWID;
CREATE INDEX labels_value ON labels (key, value, ordinal);

CREATE TABLE events (
  ordinal  INTEGER NOT NULL REFERENCES jobs (ordinal) ON DELETE CASCADE,
  sequence INTEGER NOT NULL,
  body     BLOB    NOT NULL,                            -- v1.JobEvent
  PRIMARY KEY (ordinal, sequence)
) STRICT, WITHOUT ROWID;

CREATE TABLE counters (name TEXT PRIMARY KEY, value INTEGER NOT NULL) STRICT;
INSERT INTO counters (name, value) VALUES ('fencing_token', 0);
)sql";

// Where a job stands in its queue, ms.
constexpr char kRankColumn[] = "ALTER TABLE jobs ADD COLUMN rank_ms INTEGER NOT NULL DEFAULT 0";

constexpr std::array kMigrations = {
    Migration{1, "jobs and events", kJobsAndEvents}, Migration{2, "index of ended jobs", kEndedIndex},
    Migration{3, "rank in the queue", kRankColumn}, Migration{4, "tenants, reuse, thinning", kTenants},
    Migration{5, "dropped checkpoints", kDroppedCheckpoints}};

}  // namespace

std::span<const Migration> sqlite_migrations() { return kMigrations; }

}  // namespace skinframe::server
