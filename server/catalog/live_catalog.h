// SPDX-License-Identifier: Apache-2.0
// The catalogue in force. Whoever looks things up takes it once and keeps it for the whole answer, so that
// an exchange in between is never seen by halves.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "server/catalog/catalog.h"

namespace skinframe::server {

class LiveCatalog {
 public:
  explicit LiveCatalog(Catalog first) : current_(std::make_shared<const Catalog>(std::move(first))) {}

  std::shared_ptr<const Catalog> current() const {
    const std::lock_guard lock(mutex_);
    return current_;
  }
  void replace(Catalog next) {
    auto made = std::make_shared<const Catalog>(std::move(next));
    const std::lock_guard lock(mutex_);
    current_.swap(made);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Catalog> current_;  // guarded by mutex_
};

}  // namespace skinframe::server
