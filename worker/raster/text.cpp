// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/raster/text.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "worker/raster/font_atlas.h"

namespace skinframe {
namespace {

// Latin-1 codes; 1 to 4 bytes of UTF-8 each.
std::vector<unsigned> characters_of(std::string_view text) {
  std::vector<unsigned> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80       ? 1
                               : lead >> 5 == 6  ? 2
                               : lead >> 4 == 14 ? 3
                               : lead >> 3 == 30 ? 4
                                                 : 0;
    unsigned code = lead;
    bool valid = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; valid && k < length; ++k)
      valid = (static_cast<unsigned char>(text[i + k]) & 0xC0U) == 0x80;
    if (valid && length == 2) code = (lead & 0x1FU) << 6 | (static_cast<unsigned char>(text[i + 1]) & 0x3FU);
    const bool known =
        valid && length <= 2 && code >= kAtlasFirst && code <= kAtlasLast && (code < 127 || code > 159);
    out.push_back(known ? code : '?');
    i += valid ? length : 1;
  }
  return out;
}

const AtlasGlyph& glyph_of(unsigned character) { return kAtlasGlyphs[character - kAtlasFirst]; }

// Mean coverage of the cell over [x0, x1) x [y0, y1), in the atlas' pixels.
double coverage(const AtlasGlyph& glyph, double x0, double x1, double y0, double y1) {
  double sum = 0;
  const int top = std::max(0, static_cast<int>(std::floor(y0)));
  const int left = std::max(0, static_cast<int>(std::floor(x0)));
  for (int y = top; y < glyph.height && y < y1; ++y) {
    const double height = std::min(y1, y + 1.0) - std::max(y0, double(y));
    const unsigned char* row = kAtlasCoverage + glyph.offset + std::size_t(y) * std::size_t(glyph.width);
    for (int x = left; x < glyph.width && x < x1; ++x)
      sum += row[x] * height * (std::min(x1, x + 1.0) - std::max(x0, double(x)));
  }
  return sum / (255.0 * (x1 - x0) * (y1 - y0));
}

}  // namespace

double text_width_px(std::string_view text, double size_px) {
  double width = 0;
  for (const unsigned c : characters_of(text)) width += glyph_of(c).advance;
  return width * size_px / kAtlasPixels;
}

void draw_text(Image& image, double x, double y, std::string_view text, double size_px, Colour colour,
               Align align) {
  const double cells = kAtlasPixels / std::clamp(size_px, 4.0, 400.0);  // of the atlas, to a pixel
  double pen = x;
  if (align != Align::kLeft) pen -= text_width_px(text, size_px) * (align == Align::kCentre ? 0.5 : 1.0);
  for (const unsigned c : characters_of(text)) {
    const AtlasGlyph& glyph = glyph_of(c);
    const double left = pen + glyph.left / cells, top = y - glyph.top / cells;
    const int x_end = static_cast<int>(std::ceil(left + glyph.width / cells));
    const int y_end = static_cast<int>(std::ceil(top + glyph.height / cells));
    for (int py = static_cast<int>(std::floor(top)); py < y_end; ++py)
      for (int px = static_cast<int>(std::floor(left)); px < x_end; ++px) {
        const double share = coverage(glyph, (px - left) * cells, (px + 1 - left) * cells, (py - top) * cells,
                                      (py + 1 - top) * cells);
        if (share > 0) image.blend(px, py, colour, share);
      }
    pen += glyph.advance / cells;
  }
}

std::string fit_text(std::string_view text, double size_px, double width_px) {
  constexpr std::size_t kMost =
      1000;  // characters; no line of a picture holds more, and the loop is quadratic
  if (text.size() <= kMost && text_width_px(text, size_px) <= width_px) return std::string(text);
  std::string kept(text.substr(0, kMost));
  while (!kept.empty() && text_width_px(kept + "...", size_px) > width_px) {
    do kept.pop_back();
    while (!kept.empty() && (static_cast<unsigned char>(kept.back()) & 0xC0U) == 0x80);
    // A lead byte without its tail goes as well.
    if (!kept.empty() && static_cast<unsigned char>(kept.back()) >= 0xC0) kept.pop_back();
  }
  return kept + "...";
}

}  // namespace skinframe
