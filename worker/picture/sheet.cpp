// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/picture/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "worker/raster/colour_map.h"
#include "worker/raster/strokes.h"
#include "worker/raster/text.h"

namespace skinframe::picture {
namespace {

constexpr Colour kSoft{104, 110, 120};

}  // namespace

Sheet::Sheet(int width_px, int height_px, const std::string& title, const std::string& below, bool with_bar)
    : image_(width_px, height_px, kWhite), text_px_(std::max(8.0, width_px / 42.0)) {
  const double margin = text_px_, wide = width_px - 2 * margin;
  draw_text(image_, margin, 1.6 * text_px_, fit_text(title, 1.2 * text_px_, wide), 1.2 * text_px_, kInk);
  draw_text(image_, margin, 3.0 * text_px_, fit_text(below, text_px_, wide), text_px_, kSoft);
  const int top = static_cast<int>(3.6 * text_px_), edge = static_cast<int>(margin / 2);
  const int bar = with_bar ? static_cast<int>(6.5 * text_px_) : 0;
  body_ = {edge, top, std::max(1, width_px - 2 * edge - bar),
           std::max(1, height_px - top - static_cast<int>(2.2 * text_px_))};
}

void Sheet::colour_bar(double low, double high, const std::string& unit) {
  const double left = image_.width() - 5.2 * text_px_, right = left + 1.1 * text_px_;
  const double top = body_.y + 0.15 * body_.height, bottom = body_.y + 0.85 * body_.height;
  const auto place = [&](double value) {
    return high > low ? bottom - (value - low) / (high - low) * (bottom - top) : bottom;
  };
  for (int y = static_cast<int>(top); y < bottom; ++y)
    fill_rectangle(image_, left, y, right, std::min(y + 1.0, bottom),
                   viridis((bottom - y - 0.5) / (bottom - top)));
  draw_text(image_, image_.width() - 0.5 * text_px_, top - text_px_, unit, text_px_, kInk, Align::kRight);
  const double step = tick_step(low, high);
  const auto mark = [&](double value, const std::string& text) {
    fill_rectangle(image_, right, place(value) - 0.5, right + 0.35 * text_px_, place(value) + 0.5, kInk);
    draw_text(image_, right + 0.6 * text_px_, place(value) + 0.35 * text_px_, text, text_px_, kInk);
  };
  // The ends are what the reader asks for; numbers between them keep their distance.
  const double room = 1.2 * text_px_;
  mark(low, fmt::format("{:.3g}", low));
  if (!(high > low)) return;
  mark(high, fmt::format("{:.3g}", high));
  for (double value = std::ceil(low / step) * step; value < high; value += step)
    if (place(low) - place(value) > room && place(value) - place(high) > room)
      mark(value, tick_text(value, step));
}

void Sheet::legend(Colour colour, const std::string& meaning) {
  const double y = image_.height() - text_px_ * (1.0 + 1.5 * legends_++);
  fill_rectangle(image_, text_px_, y - 0.75 * text_px_, 1.75 * text_px_, y, colour);
  draw_text(image_, 2.2 * text_px_, y, meaning, text_px_, kInk);
}

double tick_step(double low, double high) {
  if (!(high > low)) return 1;
  const double power = std::pow(10, std::floor(std::log10((high - low) / 4)));
  for (const double factor : {1.0, 2.0, 5.0})
    if ((high - low) / (factor * power) <= 8) return factor * power;
  return 10 * power;
}

std::string tick_text(double value, double step) {
  const int digits = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9);
  return fmt::format("{:.{}f}", std::abs(value) < step * 1e-9 ? 0.0 : value, digits);
}

}  // namespace skinframe::picture
