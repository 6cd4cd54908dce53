// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "worker/run/result.h"

namespace skinframe {

// The document under a temporary name, then renamed: a file of that name is always whole. Makes the folder.
Status write_json(const std::filesystem::path& path, const nlohmann::json& document);

}  // namespace skinframe
