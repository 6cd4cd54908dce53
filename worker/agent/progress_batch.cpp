// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/progress_batch.h"

#include <algorithm>
#include <utility>

namespace skinframe::agent {

void ProgressBatch::add(v1::JobProgress progress) {
  last_ = progress;
  last_->clear_note();
  // The newest of this printer: others may run beside it.
  const auto same = std::find_if(progress_.rbegin(), progress_.rend(), [&](const v1::JobProgress& told) {
    return told.printer_id() == progress.printer_id();
  });
  if (same != progress_.rend() && same->note().empty() && progress.note().empty() &&
      same->stage() == progress.stage() && same->iteration() == progress.iteration()) {
    *same = std::move(progress);
  } else {
    progress_.push_back(std::move(progress));
    trim();
  }
}

void ProgressBatch::add(v1::PrinterResult printer) { printers_.push_back(std::move(printer)); }

void ProgressBatch::take(v1::HeartbeatRequest& request) {
  if (empty() && last_) *request.add_progress() = *last_;
  for (auto& progress : progress_) *request.add_progress() = std::move(progress);
  for (auto& printer : printers_) *request.add_printers() = std::move(printer);
  progress_.clear();
  printers_.clear();
}

void ProgressBatch::give_back(const v1::HeartbeatRequest& request) {
  progress_.insert(progress_.begin(), request.progress().begin(), request.progress().end());
  printers_.insert(printers_.begin(), request.printers().begin(), request.printers().end());
  trim();
}

void ProgressBatch::trim() {
  while (progress_.size() > kMaxProgress) progress_.pop_front();
}

}  // namespace skinframe::agent
