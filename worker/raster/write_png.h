// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "worker/raster/image.h"
#include "worker/run/result.h"

namespace skinframe {

// Same picture, same bytes: no time, no name of a program is written. Written beside `path` first and
// renamed. Errors: kIo, naming the file.
Status write_png(const Image& image, const std::filesystem::path& path);

}  // namespace skinframe
