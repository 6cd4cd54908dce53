// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "client/call/connect.h"
#include "client/transfer/input_file.h"

namespace skinframe::client {

// The mesh or frame problem file is on the server, whole and durable, or: kInput (see digest_input_file; also
// a size that the server refuses, a file that changed under our hands), kUnreachable, kInterrupted. What the
// server has already costs nothing, an interrupted upload goes on where it stopped.
Result<FileDigest> upload_input(const Connection& connection, const std::filesystem::path& path);

}  // namespace skinframe::client
