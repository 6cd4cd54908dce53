// SPDX-License-Identifier: Apache-2.0
// A server names the files that the client writes: what it says must not lead out of the folder.
#pragma once

#include <filesystem>
#include <string>

#include "client/call/result.h"

namespace skinframe::client {

// folder / relative, when relative is made of plain names only: not empty, not absolute, no "." or "..", no
// empty part, no backslash, no control character, and no part longer than 255 bytes. kInternal otherwise: no
// sane server says that.
Result<std::filesystem::path> path_inside(const std::filesystem::path& folder, const std::string& relative);

}  // namespace skinframe::client
