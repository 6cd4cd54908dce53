// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as colours: viridis (van der Walt, Smith 2015, CC0), perceptually even, its lightness rising from
// dark violet to yellow, so that it reads in grey and to most colour-blind eyes too.
#pragma once

#include "worker/raster/image.h"

namespace skinframe {

// share in [0, 1]; beyond is clamped, NaN is 0.
Colour viridis(double share);

}  // namespace skinframe
