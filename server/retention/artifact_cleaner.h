// SPDX-License-Identifier: Apache-2.0
// Removes artifacts that no job refers to, and abandoned parts of uploads, when nobody has used them for a
// while.
//
// Why nothing that is referred to can go: candidates are those unused since `unused` ago, found first; then
// all jobs are read, and what they refer to is taken out. A job that is submitted meanwhile asks for its mesh
// before it is made, and a worker's result is asked for before it is accepted: that counts as use, and an
// artifact's last use is looked at once more when it goes (ArtifactStore::remove_unused). The tenants are
// gone through one by one; what a job refers to is kept in all of them.
#pragma once

#include <set>
#include <string>

#include "server/artifacts/tenant_artifacts.h"
#include "server/leases/duty.h"
#include "server/store/job_store.h"

namespace skinframe::server {

// All artifacts that the job refers to: its input, its results, its checkpoint, and until it has ended the
// files of a warm start.
std::set<std::string> artifacts_of(const ListPage::Entry& entry);

class ArtifactCleaner final : public Duty {
 public:
  // unused: longer than any client takes from its upload to its submission.
  ArtifactCleaner(JobStore& store, TenantArtifacts& artifacts, Milliseconds unused, Milliseconds every)
      : store_(store), artifacts_(artifacts), unused_(unused), every_(every) {}
  std::string_view name() const override { return "artifact cleaner"; }
  absl::Status run_once(Time now) override;

 private:
  absl::Status clean(ArtifactStore& artifacts, std::chrono::system_clock::time_point since);
  absl::Status keep_referred(std::set<std::string>& candidates);

  JobStore& store_;
  TenantArtifacts& artifacts_;
  const Milliseconds unused_;
  const Milliseconds every_;
  Time looked_{};
};

}  // namespace skinframe::server
