// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "client/call/result.h"
#include "proto/transport/sha256.h"

namespace skinframe::client {

using transport::FileDigest;

// kInput when the file is missing, no regular file, unreadable or empty.
Result<FileDigest> digest_input_file(const std::filesystem::path& path);

}  // namespace skinframe::client
