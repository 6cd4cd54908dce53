// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres_migrations.h"

#include <array>

#include "server/store/common_migrations.h"

namespace skinframe::server {
namespace {

// Times are milliseconds since 1970. State numbers are those of v1::JobState: 1 queued, 2 running. The rows
// of jobs change often and in place: room is left in their pages, and the heap is cleaned early.
constexpr char kJobsAndEvents[] = R"sql(
CREATE TABLE jobs (
  ordinal           BIGINT  PRIMARY KEY GENERATED ALWAYS AS IDENTITY,  -- order of submission
  job_id            TEXT    NOT NULL UNIQUE,
  request_id        TEXT    UNIQUE,                     -- NULL: the client gave none
  spec_digest       TEXT    NOT NULL,
  spec              BYTEA   NOT NULL,                   -- v1.JobSpec
  profiles          BYTEA   NOT NULL,                   -- v1.Assignment with printers and materials alone
  priority          INTEGER NOT NULL,
  create_ms         BIGINT  NOT NULL,
  deadline_ms       BIGINT,
  state             INTEGER NOT NULL,
  reason            INTEGER NOT NULL,
  detail            TEXT    NOT NULL,
  results           BYTEA   NOT NULL,                   -- v1.Job with printers and files alone
  start_ms          BIGINT,
  end_ms            BIGINT,
  attempt           INTEGER NOT NULL,
  lost_attempts     INTEGER NOT NULL,
  not_before_ms     BIGINT  NOT NULL,
  cancel_requested  INTEGER NOT NULL,
  last_sequence     BIGINT  NOT NULL,
  fencing_token     BIGINT  NOT NULL,
  worker_id         TEXT    NOT NULL,
  instance_id       TEXT    NOT NULL,
  lease_expires_ms  BIGINT  NOT NULL,
  completion_digest TEXT    NOT NULL
) WITH (fillfactor = 70, autovacuum_vacuum_scale_factor = 0.02);
CREATE INDEX jobs_queue    ON jobs (priority DESC, ordinal) WHERE state = 1;
CREATE INDEX jobs_deadline ON jobs (deadline_ms) WHERE state = 1 AND deadline_ms IS NOT NULL;
CREATE INDEX jobs_lease    ON jobs (lease_expires_ms) WHERE state = 2;
CREATE INDEX jobs_state    ON jobs (state, ordinal);

CREATE TABLE labels (
  ordinal BIGINT NOT NULL REFERENCES jobs (ordinal) ON DELETE CASCADE,
  key     TEXT   NOT NULL,
  value   TEXT   NOT NULL,
  PRIMARY KEY (ordinal, key)
);
CREATE INDEX labels_value ON labels (key, value, ordinal);

CREATE TABLE events (
  ordinal  BIGINT NOT NULL REFERENCES jobs (ordinal) ON DELETE CASCADE,
  sequence BIGINT NOT NULL,
  body     BYTEA  NOT NULL,                             -- v1.JobEvent
  PRIMARY KEY (ordinal, sequence)
);

CREATE SEQUENCE fencing_tokens;
)sql";

// Where a job stands in its queue, ms.
constexpr char kRankColumn[] = "ALTER TABLE jobs ADD COLUMN rank_ms BIGINT NOT NULL DEFAULT 0";

constexpr std::array kMigrations = {
    Migration{1, "jobs and events", kJobsAndEvents}, Migration{2, "index of ended jobs", kEndedIndex},
    Migration{3, "rank in the queue", kRankColumn}, Migration{4, "tenants, reuse, thinning", kTenants},
    Migration{5, "dropped checkpoints", kDroppedCheckpoints}};

}  // namespace

std::span<const Migration> postgres_migrations() { return kMigrations; }

}  // namespace skinframe::server
