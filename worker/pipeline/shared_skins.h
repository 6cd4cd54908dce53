// SPDX-License-Identifier: GPL-3.0-or-later
// Skins of one job's solid by their thickness: printers of one thickness share one, built by the first that
// asks, while the others wait for it.
//
// Guarantees:
//  1. A skin is built once for all printers that it was announced for, whatever the threads.
//  2. It lives as long as one of them has it or has not asked yet.
//  3. What could not be built is told to all who wait, and is tried anew for who asks later.
#pragma once

#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>

#include "worker/skin/build_skin.h"

namespace skinframe {

class SharedSkins {
 public:
  using Shared = Result<std::shared_ptr<const Skin>>;

  // A printer of that thickness will ask.
  void announce(double thickness_mm);
  // Exceptions of `build` pass through, to those who wait as well.
  Shared get(double thickness_mm, const std::function<Result<Skin>()>& build);

 private:
  struct Entry {
    int to_come = 0;                       // printers that have not asked yet
    std::shared_future<Shared> in_making;  // or made; not valid before somebody asks
  };
  std::mutex mutex_;
  std::map<double, Entry> entries_;
};

}  // namespace skinframe
