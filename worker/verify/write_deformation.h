// SPDX-License-Identifier: GPL-3.0-or-later
// deformation-NAME.ply: how far the skin gives way under one load, for any mesh viewer.
//
// Binary, little endian. The skin's mid-surface where it stands unloaded, a vertex with floats x y z, uchars
// red green blue (blue where it stands still, red where it moves most), and floats displacement_x, _y, _z in
// mm; then its triangles. Two comments name the load and the largest displacement.
#pragma once

#include <filesystem>

#include "worker/run/result.h"
#include "worker/verify/verification.h"

namespace skinframe {

// Error: kIo, naming the file.
Status write_deformation(const Verification& verification, const Deformation& deformation,
                         const std::filesystem::path& path);

// share 0: blue, 1/3: cyan, 2/3: yellow, 1: red.
std::array<unsigned char, 3> colour_of(double share);

}  // namespace skinframe
