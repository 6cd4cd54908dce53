// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of 8-bit sRGB pixels, rows from above. Pixel (x, y) covers [x, x+1) x [y, y+1).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace skinframe {

using Colour = std::array<std::uint8_t, 3>;

inline constexpr Colour kWhite{255, 255, 255}, kInk{32, 36, 42}, kFaint{214, 218, 224};

class Image {
 public:
  // Sides from 1 to kMaxSidePx each.
  Image(int width_px, int height_px, Colour background);

  int width() const { return width_; }
  int height() const { return height_; }
  Colour at(int x, int y) const;  // inside only
  // Outside the picture nothing happens. cover 0 leaves the pixel, 1 replaces it.
  void blend(int x, int y, Colour colour, double cover = 1.0);
  // Copies `other` with its corner at (x, y); what reaches over the rim is left out.
  void paste(const Image& other, int x, int y);
  const std::uint8_t* row(int y) const { return &bytes_[3 * std::size_t(y) * std::size_t(width_)]; }

  bool operator==(const Image&) const = default;

 private:
  int width_, height_;
  std::vector<std::uint8_t> bytes_;
};

inline constexpr int kMaxSidePx = 8192;

}  // namespace skinframe
