// SPDX-License-Identifier: Apache-2.0
#include "server/retention/checkpoint_cleaner.h"

#include <spdlog/spdlog.h>

#include "server/retention/artifact_cleaner.h"

namespace skinframe::server {
namespace {
constexpr int kMostAtOnce = 1000;
constexpr int kPage = 200;  // other duties have their turn in between
}  // namespace

absl::Status CheckpointCleaner::run_once(Time now) {
  const bool clock_set_back = now < listed_;
  if (dropped_.empty())
    return clock_set_back || now - listed_ >= every_ ? list_dropped(now) : absl::OkStatus();
  if (clock_set_back) return list_dropped(now);  // the grace begins anew
  if (now - listed_ < grace_) return absl::OkStatus();
  return all_read_ || unreferred_.empty() ? remove_the_rest() : read_page();
}

absl::Status CheckpointCleaner::list_dropped(Time now) {
  listed_ = now;
  auto dropped = store_.dropped_checkpoints(kMostAtOnce);
  if (!dropped.ok()) return dropped.status();
  dropped_ = *std::move(dropped);
  unreferred_.clear();
  for (const DroppedCheckpoint& checkpoint : dropped_) unreferred_.insert(checkpoint.sha256);
  read_to_ = 0;
  all_read_ = false;
  return absl::OkStatus();
}

absl::Status CheckpointCleaner::read_page() {
  ListQuery query;
  query.limit = kPage;
  query.before_ordinal = read_to_;
  const auto page = store_.list(query);
  if (!page.ok()) return page.status();
  for (const ListPage::Entry& entry : page->entries) {
    for (const std::string& name : artifacts_of(entry)) unreferred_.erase(name);
    read_to_ = entry.ordinal;
  }
  all_read_ = !page->more;
  return absl::OkStatus();
}

absl::Status CheckpointCleaner::remove_the_rest() {
  const std::chrono::system_clock::time_point since(
      std::chrono::duration_cast<std::chrono::system_clock::duration>(listed_.time_since_epoch()));
  int removed = 0;
  for (const DroppedCheckpoint& checkpoint : dropped_) {
    if (!unreferred_.contains(checkpoint.sha256)) continue;
    const auto store = artifacts_.of(checkpoint.tenant);
    if (!store.ok()) return store.status();
    const auto gone = (*store)->remove_unused(checkpoint.sha256, since);
    if (!gone.ok()) return gone.status();
    if (*gone) ++removed;
  }
  if (absl::Status status = store_.forget_dropped(dropped_); !status.ok()) return status;
  dropped_.clear();
  if (removed > 0) spdlog::debug("artifacts: removed {} checkpoints that no job goes on from", removed);
  return absl::OkStatus();
}

}  // namespace skinframe::server
