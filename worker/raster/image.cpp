// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/raster/image.h"

#include <algorithm>
#include <cmath>

#include "worker/run/result.h"

namespace skinframe {

Image::Image(int width_px, int height_px, Colour background) : width_(width_px), height_(height_px) {
  SKINFRAME_CHECK(width_px >= 1 && width_px <= kMaxSidePx && height_px >= 1 && height_px <= kMaxSidePx);
  const std::size_t pixels = std::size_t(width_px) * std::size_t(height_px);
  bytes_.resize(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) std::copy_n(background.begin(), 3, &bytes_[3 * i]);
}

Colour Image::at(int x, int y) const {
  const std::uint8_t* p = row(y) + 3 * x;
  return {p[0], p[1], p[2]};
}

void Image::blend(int x, int y, Colour colour, double cover) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  const double share = std::clamp(cover, 0.0, 1.0);
  std::uint8_t* p = &bytes_[3 * (std::size_t(y) * std::size_t(width_) + std::size_t(x))];
  for (int k = 0; k < 3; ++k)
    p[k] = static_cast<std::uint8_t>(std::lround(p[k] + share * (colour[k] - p[k])));
}

void Image::paste(const Image& other, int x, int y) {
  const int from = std::max(0, -x), to = std::min(other.width(), width_ - x);
  if (from >= to) return;
  for (int row_of = std::max(0, -y); row_of < std::min(other.height(), height_ - y); ++row_of)
    std::copy(other.row(row_of) + 3 * from, other.row(row_of) + 3 * to,
              &bytes_[3 * (std::size_t(y + row_of) * std::size_t(width_) + std::size_t(x + from))]);
}

}  // namespace skinframe
