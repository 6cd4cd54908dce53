// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/shared_skins.h"

#include <exception>
#include <utility>

namespace skinframe {

void SharedSkins::announce(double thickness_mm) {
  const std::scoped_lock lock(mutex_);
  ++entries_[thickness_mm].to_come;
}

SharedSkins::Shared SharedSkins::get(double thickness_mm, const std::function<Result<Skin>()>& build) {
  std::promise<Shared> promise;
  std::shared_future<Shared> in_making;
  bool is_first = false;
  {
    const std::scoped_lock lock(mutex_);
    Entry& entry = entries_[thickness_mm];
    is_first = !entry.in_making.valid();
    if (is_first) entry.in_making = promise.get_future().share();
    in_making = entry.in_making;
    if (--entry.to_come <= 0) entries_.erase(thickness_mm);
  }
  if (!is_first) return in_making.get();
  const auto forget = [&] {
    const std::scoped_lock lock(mutex_);
    if (const auto at = entries_.find(thickness_mm); at != entries_.end()) at->second.in_making = {};
  };
  try {
    auto made = build();
    if (!made) forget();
    promise.set_value(made ? Shared(std::make_shared<const Skin>(std::move(made).value()))
                           : Shared(made.error()));
  } catch (...) {
    forget();
    promise.set_exception(std::current_exception());
  }
  return in_making.get();
}

}  // namespace skinframe
