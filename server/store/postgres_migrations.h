// SPDX-License-Identifier: Apache-2.0
// The shape of the PostgreSQL store: that of the SQLite store in PostgreSQL's types.
#pragma once

#include <span>

#include "server/store/migrations.h"
#include "server/store/postgres_session.h"

namespace skinframe::server {

std::span<const Migration> postgres_migrations();

}  // namespace skinframe::server
