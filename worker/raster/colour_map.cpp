// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/raster/colour_map.h"

#include <cmath>

namespace skinframe {
namespace {

// Every sixteenth of the map; linear between them, off by less than two of 255.
constexpr std::array<Colour, 17> kViridis = {{{68, 1, 84},
                                              {72, 24, 106},
                                              {71, 45, 123},
                                              {66, 64, 134},
                                              {59, 82, 139},
                                              {51, 99, 141},
                                              {44, 114, 142},
                                              {38, 130, 142},
                                              {33, 145, 140},
                                              {31, 160, 136},
                                              {40, 174, 128},
                                              {63, 188, 115},
                                              {94, 201, 98},
                                              {132, 212, 75},
                                              {173, 220, 48},
                                              {216, 226, 25},
                                              {253, 231, 37}}};

}  // namespace

Colour viridis(double share) {
  if (!(share > 0)) return kViridis.front();
  if (share >= 1) return kViridis.back();
  const double place = share * (kViridis.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  Colour out{};
  for (int k = 0; k < 3; ++k)
    out[k] = static_cast<std::uint8_t>(std::lround(
        kViridis[below][k] + (place - double(below)) * (kViridis[below + 1][k] - kViridis[below][k])));
  return out;
}

}  // namespace skinframe
