// SPDX-License-Identifier: Apache-2.0
#include "server/events/event_pages.h"

#include <algorithm>
#include <utility>

namespace skinframe::server {

absl::StatusOr<EventPage> EventPages::after(const std::string& job_id, std::int64_t sequence) {
  const auto is_it = [&](const Known& page) {
    return page.events != nullptr && page.sequence == sequence && page.job_id == job_id;
  };
  const auto full = [](const auto& events) { return events->size() >= kPage; };
  const std::uint64_t news = hub_.news(job_id);  // before the read: what comes in between counts as later
  {
    const std::lock_guard lock(mutex_);
    const auto page = std::find_if(known_.begin(), known_.end(), is_it);
    if (page != known_.end()) {
      if (full(page->events)) return EventPage{page->events, false};
      if (news != WatchHub::kUnknown && page->news == news) return EventPage{page->events, true};
    }
  }
  auto read = read_(job_id, sequence, kPage);
  if (!read.ok()) return read.status();
  const auto events = std::make_shared<const std::vector<v1::JobEvent>>(*std::move(read));
  const std::lock_guard lock(mutex_);
  auto place = std::find_if(known_.begin(), known_.end(), is_it);
  if (place == known_.end()) place = known_.begin() + static_cast<std::ptrdiff_t>(next_++ % kKnown);
  if (!is_it(*place) || place->news <= news) *place = {job_id, sequence, news, events};
  return EventPage{events, !full(events)};
}

}  // namespace skinframe::server
