// SPDX-License-Identifier: Apache-2.0
// The shape of the SQLite store.
#pragma once

#include <span>

#include "server/store/migrations.h"
#include "server/store/sqlite_database.h"

namespace skinframe::server {

std::span<const Migration> sqlite_migrations();

}  // namespace skinframe::server
