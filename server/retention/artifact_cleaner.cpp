// SPDX-License-Identifier: Apache-2.0
#include "server/retention/artifact_cleaner.h"

#include <spdlog/spdlog.h>

#include <vector>

#include "server/jobs/transitions.h"

namespace skinframe::server {
namespace {
constexpr int kPage = 200;
}

std::set<std::string> artifacts_of(const ListPage::Entry& entry) {
  const v1::Job& job = entry.job;
  std::set<std::string> names = {job.spec().mesh_sha256(), job.spec().frame_problem_sha256()};
  for (const v1::ResultFile& file : job.files()) names.insert(file.sha256());
  names.insert(job.checkpoint().sha256());
  if (!is_final(job.state()))
    for (const v1::ResultFile& file : entry.warm_start_files) names.insert(file.sha256());
  names.erase("");
  return names;
}

absl::Status ArtifactCleaner::keep_referred(std::set<std::string>& candidates) {
  ListQuery query;
  query.limit = kPage;
  for (bool more = true; more && !candidates.empty();) {
    const auto page = store_.list(query);
    if (!page.ok()) return page.status();
    for (const ListPage::Entry& entry : page->entries) {
      for (const std::string& name : artifacts_of(entry)) candidates.erase(name);
      query.before_ordinal = entry.ordinal;
    }
    more = page->more;
  }
  return absl::OkStatus();
}

absl::Status ArtifactCleaner::run_once(Time now) {
  if (now >= looked_ && now - looked_ < every_) return absl::OkStatus();
  looked_ = now;
  const std::chrono::system_clock::time_point since(
      std::chrono::duration_cast<std::chrono::system_clock::duration>((now - unused_).time_since_epoch()));
  const auto stores = artifacts_.all();
  if (!stores.ok()) return stores.status();
  for (ArtifactStore* store : *stores) {
    if (absl::Status status = clean(*store, since); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status ArtifactCleaner::clean(ArtifactStore& artifacts, std::chrono::system_clock::time_point since) {
  const auto unused = artifacts.unused_since(since);
  if (!unused.ok()) return unused.status();
  std::set<std::string> candidates(unused->begin(), unused->end());
  if (absl::Status status = keep_referred(candidates); !status.ok()) return status;
  int removed = 0;
  for (const std::string& name : candidates) {
    const auto gone = artifacts.remove_unused(name, since);
    if (!gone.ok()) return gone.status();
    if (*gone) ++removed;
  }
  const auto parts = artifacts.remove_abandoned_parts(since);
  if (!parts.ok()) return parts.status();
  if (removed + *parts > 0)
    spdlog::info("artifacts: removed {} that no job refers to, and {} abandoned parts", removed, *parts);
  return absl::OkStatus();
}

}  // namespace skinframe::server
