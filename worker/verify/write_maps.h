// SPDX-License-Identifier: GPL-3.0-or-later
// What is seen of a verification: coloured_skin.h with the figures of one load, or of all pinches.
#pragma once

#include <filesystem>

#include "worker/run/result.h"
#include "worker/verify/verification.h"

namespace skinframe {

// deformation-NAME.ply: figures displacement_x, _y, _z in mm; blue where the skin stands still, red where it
// moves most. Two comments name the load and the largest displacement. Error: kIo, naming the file.
Status write_deformation(const Verification& verification, const Deformation& deformation,
                         const std::filesystem::path& path);

// pinch.ply: figure closing in mm, at each vertex that of the finger nearest to it; red where that is
// largest. Pre-condition: the design has been pinched. Error: kIo, naming the file.
Status write_pinch_map(const Verification& verification, const std::filesystem::path& path);

}  // namespace skinframe
