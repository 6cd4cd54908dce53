// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/progress_batch.h"

#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <utility>

namespace skinframe::agent {

using google::protobuf::util::MessageDifferencer;

void ProgressBatch::add(v1::JobProgress progress) {
  const bool nothing_new = empty() && last_ && MessageDifferencer::Equals(*last_, progress);
  if (nothing_new) return;
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

void ProgressBatch::take(v1::HeartbeatRequest& request, TimePoint now) {
  const bool again = last_ && (now - changed_ < kTellAgainFor || now - told_ >= kTellAgainEvery);
  if (!empty()) changed_ = now;
  if (empty() && again) *request.add_progress() = *last_;
  if (!empty() || again) told_ = now;
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
