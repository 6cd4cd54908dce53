// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite_migrations.h"

#include <array>

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

// For the retention of ended jobs.
constexpr char kEndedIndex[] = "CREATE INDEX jobs_ended ON jobs (end_ms) WHERE state > 2";

// Tenants, and within each a queue in the order of rank_ms; earlier results by what they were asked for;
// events of progress, which may go, told from those that stay.
constexpr char kTenants[] = R"sql(
ALTER TABLE jobs ADD COLUMN tenant TEXT NOT NULL DEFAULT 'default';
ALTER TABLE jobs ADD COLUMN rank_ms INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN reuse_key TEXT;
ALTER TABLE jobs ADD COLUMN thinned INTEGER NOT NULL DEFAULT 0;
ALTER TABLE events ADD COLUMN progress INTEGER NOT NULL DEFAULT 0;
UPDATE jobs SET rank_ms = create_ms - priority * 600000;
DROP INDEX jobs_queue;
DROP INDEX jobs_deadline;
DROP INDEX jobs_lease;
DROP INDEX jobs_state;
CREATE INDEX jobs_queue    ON jobs (tenant, rank_ms, ordinal) WHERE state = 1;
CREATE INDEX jobs_deadline ON jobs (state, deadline_ms) WHERE deadline_ms IS NOT NULL;
CREATE INDEX jobs_lease    ON jobs (state, lease_expires_ms) WHERE state = 2;
CREATE INDEX jobs_state    ON jobs (state, tenant, ordinal);
CREATE INDEX jobs_reuse    ON jobs (tenant, reuse_key, ordinal) WHERE state = 3 AND reuse_key IS NOT NULL;
CREATE INDEX jobs_thin     ON jobs (end_ms) WHERE state > 2 AND thinned = 0;
CREATE INDEX jobs_tenant   ON jobs (tenant, ordinal);
)sql";

constexpr std::array kMigrations = {Migration{1, "jobs and events", kJobsAndEvents},
                                    Migration{2, "index of ended jobs", kEndedIndex},
                                    Migration{3, "tenants, ranks, reuse, thinning", kTenants}};

}  // namespace

std::span<const Migration> sqlite_migrations() { return kMigrations; }

}  // namespace skinframe::server
