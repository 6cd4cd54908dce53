// SPDX-License-Identifier: GPL-3.0-or-later
// The characters of Latin-1 as grey cells, drawn when the program was built (make_font_atlas.cpp) from
// DejaVu Sans, whose licence (Bitstream Vera) permits it.
#pragma once

namespace skinframe {

struct AtlasGlyph {
  unsigned offset;    // of its first value in kAtlasCoverage; rows from above, without padding
  int width, height;  // of the cell
  int left, top;      // of the cell's corner from the pen: to the right, and up from the base line
  double advance;     // of the pen
};

inline constexpr unsigned kAtlasFirst = 32, kAtlasLast = 255;
extern const int kAtlasPixels;  // height of the font's square; all of the above count in its pixels
extern const AtlasGlyph kAtlasGlyphs[kAtlasLast - kAtlasFirst + 1];
extern const unsigned char kAtlasCoverage[];  // 0 .. 255

}  // namespace skinframe
