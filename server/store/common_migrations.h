// SPDX-License-Identifier: Apache-2.0
// Steps that read the same in SQLite and PostgreSQL; each store has them in its own list.
#pragma once

namespace skinframe::server {

// For the retention of ended jobs.
inline constexpr char kEndedIndex[] = "CREATE INDEX jobs_ended ON jobs (end_ms) WHERE state > 2";

// After kRankColumn of each store: tenants, and within each a queue in the order of rank_ms; earlier results
// by what they were asked for; events of progress, which may go, told from those that stay.
inline constexpr char kTenants[] = R"sql(
ALTER TABLE jobs ADD COLUMN tenant TEXT NOT NULL DEFAULT 'default';
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

// Files that were a job's checkpoint and are not any more, until somebody has seen to them.
inline constexpr char kDroppedCheckpoints[] =
    "CREATE TABLE dropped_checkpoints (tenant TEXT NOT NULL, sha256 TEXT NOT NULL, "
    "PRIMARY KEY (tenant, sha256))";

}  // namespace skinframe::server
