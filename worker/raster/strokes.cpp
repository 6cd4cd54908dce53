// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/raster/strokes.h"

#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

double overlap(double pixel, double from, double to) {
  return std::max(0.0, std::min(pixel + 1, to) - std::max(pixel, from));
}

// First and last pixel of [from, to) within a picture of `size`.
std::pair<int, int> pixels(double from, double to, int size) {
  return {static_cast<int>(std::floor(std::clamp(from, 0.0, double(size)))),
          static_cast<int>(std::ceil(std::clamp(to, 0.0, double(size))))};
}

}  // namespace

void fill_rectangle(Image& image, double x0, double y0, double x1, double y1, Colour colour) {
  const auto [left, right] = pixels(x0, x1, image.width());
  const auto [top, bottom] = pixels(y0, y1, image.height());
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) image.blend(x, y, colour, overlap(x, x0, x1) * overlap(y, y0, y1));
}

void draw_polyline(Image& image, const std::vector<Eigen::Vector2d>& points_px, double width_px,
                   Colour colour) {
  if (points_px.empty()) return;
  const double reach = width_px / 2 + 1;
  Eigen::Vector2d low = points_px[0], high = points_px[0];
  for (const Eigen::Vector2d& p : points_px) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const auto [left, right] = pixels(low.x() - reach, high.x() + reach, image.width());
  const auto [top, bottom] = pixels(low.y() - reach, high.y() + reach, image.height());
  if (left >= right || top >= bottom) return;
  std::vector<float> cover(std::size_t(right - left) * std::size_t(bottom - top), 0.0F);
  for (std::size_t i = 0; i < points_px.size(); ++i) {
    const Eigen::Vector2d a = points_px[i], b = points_px[std::min(i + 1, points_px.size() - 1)];
    const double length2 = (b - a).squaredNorm();
    const auto [x0, x1] =
        pixels(std::min(a.x(), b.x()) - reach, std::max(a.x(), b.x()) + reach, image.width());
    const auto [y0, y1] =
        pixels(std::min(a.y(), b.y()) - reach, std::max(a.y(), b.y()) + reach, image.height());
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const Eigen::Vector2d p(x + 0.5, y + 0.5);
        const double t = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
        const double distance = (p - a - t * (b - a)).norm();
        float& here = cover[std::size_t(y - top) * std::size_t(right - left) + std::size_t(x - left)];
        here = std::max(here, static_cast<float>(std::clamp(width_px / 2 + 0.5 - distance, 0.0, 1.0)));
      }
  }
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      image.blend(x, y, colour,
                  cover[std::size_t(y - top) * std::size_t(right - left) + std::size_t(x - left)]);
}

}  // namespace skinframe
