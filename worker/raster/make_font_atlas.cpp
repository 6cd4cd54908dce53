// SPDX-License-Identifier: GPL-3.0-or-later
// Run by the build: draws the printable characters of a font into grey cells and writes them as a C++ source
// for font_atlas.h. Usage: make_font_atlas FONT.ttf OUT.cpp
#include <ft2build.h>
#include FT_FREETYPE_H

#include <cstdio>
#include <fstream>
#include <string>

namespace {

constexpr int kPixels = 48;
constexpr unsigned kFirst = 32, kLast = 255;  // Latin-1; what has no glyph there takes the font's own box

int fail(const char* what, const char* name) {
  std::fprintf(stderr, "make_font_atlas: %s: %s\n", name, what);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return fail("needs FONT.ttf OUT.cpp", "usage");
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  if (FT_Init_FreeType(&library) != 0) return fail("FreeType does not start", argv[1]);
  if (FT_New_Face(library, argv[1], 0, &face) != 0) return fail("is no font", argv[1]);
  if (FT_Set_Pixel_Sizes(face, 0, kPixels) != 0) return fail("has no such size", argv[1]);

  std::string glyphs, coverage;
  std::size_t offset = 0;
  for (unsigned character = kFirst; character <= kLast; ++character) {
    if (FT_Load_Char(face, character, FT_LOAD_RENDER | FT_LOAD_NO_HINTING) != 0)
      return fail("a character cannot be drawn", argv[1]);
    const FT_GlyphSlot slot = face->glyph;
    const FT_Bitmap& bitmap = slot->bitmap;
    glyphs += "    {" + std::to_string(offset) + ", " + std::to_string(bitmap.width) + ", " +
              std::to_string(bitmap.rows) + ", " + std::to_string(slot->bitmap_left) + ", " +
              std::to_string(slot->bitmap_top) + ", " +
              std::to_string(static_cast<double>(slot->advance.x) / 64.0) + "},\n";
    for (unsigned y = 0; y < bitmap.rows; ++y) {
      for (unsigned x = 0; x < bitmap.width; ++x)
        coverage += std::to_string(bitmap.buffer[y * static_cast<unsigned>(bitmap.pitch) + x]) + ",";
      coverage += "\n";
    }
    offset += std::size_t{bitmap.width} * bitmap.rows;
  }
  FT_Done_Face(face);
  FT_Done_FreeType(library);

  std::ofstream out(argv[2]);
  out << "// Made by make_font_atlas from " << argv[1] << "\n#include \"worker/raster/font_atlas.h\"\n\n"
      << "namespace skinframe {\n\nconst int kAtlasPixels = " << kPixels
      << ";\nconst AtlasGlyph kAtlasGlyphs["
      << "kAtlasLast - kAtlasFirst + 1] = {\n"
      << glyphs << "};\nconst unsigned char kAtlasCoverage[] = {\n"
      << coverage << "0};\n\n}  // namespace skinframe\n";
  out.close();
  return out ? 0 : fail("cannot be written", argv[2]);
}
