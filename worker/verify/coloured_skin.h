// SPDX-License-Identifier: GPL-3.0-or-later
// The fine skin with a figure at each vertex, for any mesh viewer: what deformation-NAME.ply and pinch.ply
// are.
//
// PLY, binary, little endian. The skin's mid-surface where it stands unloaded, a vertex with floats x y z,
// uchars red green blue, and the figures as floats; then its triangles.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "worker/run/result.h"
#include "worker/verify/verification.h"

namespace skinframe {

struct ColouredSkin {
  std::vector<std::string> comments;
  std::vector<std::string> names;            // of the figures
  std::vector<std::vector<double>> figures;  // a row a vertex
  std::vector<double> shares;                // of red, a vertex
};

// Error: kIo, naming the file.
Status write_coloured_skin(const Verification& verification, const ColouredSkin& coloured,
                           const std::filesystem::path& path);

// share 0: blue, 1/3: cyan, 2/3: yellow, 1: red.
std::array<unsigned char, 3> colour_of(double share);

}  // namespace skinframe
