// SPDX-License-Identifier: Apache-2.0
// Removes the files of checkpoints that no job goes on from any more, a minute or two after their job has
// ended or has a newer one. They are the largest files that nobody asks for again; the artifact cleaner would
// leave them for a day.
//
// Why nothing that is referred to can go. A round has three steps: the dropped ones are listed; a grace later
// all jobs are read, a page at each call, and what they refer to is taken out; the rest is removed unless it
// was used since the listing (ArtifactStore::remove_unused). Whoever comes to refer to such a file asks for
// it first, which counts as use: if that was after the listing, the file stays; if before, the reference is
// in the store within the grace, and the reading finds it. What stays is left to the artifact cleaner.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "server/artifacts/tenant_artifacts.h"
#include "server/leases/duty.h"
#include "server/store/job_store.h"

namespace skinframe::server {

class CheckpointCleaner final : public Duty {
 public:
  // grace: longer than any call takes from asking for an artifact to the commit of its reference.
  CheckpointCleaner(JobStore& store, TenantArtifacts& artifacts, Milliseconds every, Milliseconds grace)
      : store_(store), artifacts_(artifacts), every_(every), grace_(grace) {}
  std::string_view name() const override { return "checkpoint cleaner"; }
  absl::Status run_once(Time now) override;

 private:
  absl::Status list_dropped(Time now);
  absl::Status read_page();
  absl::Status remove_the_rest();

  JobStore& store_;
  TenantArtifacts& artifacts_;
  const Milliseconds every_;
  const Milliseconds grace_;
  Time listed_{};                           // when the round began
  std::vector<DroppedCheckpoint> dropped_;  // this round's; empty: none is under way
  std::set<std::string> unreferred_;        // of them, so far
  std::int64_t read_to_ = 0;                // the ordinal where the next page begins
  bool all_read_ = false;
};

}  // namespace skinframe::server
