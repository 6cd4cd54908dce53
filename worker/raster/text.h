// SPDX-License-Identifier: GPL-3.0-or-later
// Text of one line in UTF-8. Characters beyond Latin-1, and bytes that are no UTF-8, are drawn as "?".
#pragma once

#include <string>
#include <string_view>

#include "worker/raster/image.h"

namespace skinframe {

enum class Align { kLeft, kCentre, kRight };

// `size_px`: of the font's square, about 1.4 times the height of a capital.
double text_width_px(std::string_view text, double size_px);

// (x, y): where the base line begins, is centred or ends. size_px in [4, 400].
void draw_text(Image& image, double x, double y, std::string_view text, double size_px, Colour colour,
               Align align = Align::kLeft);

// The text, or its beginning with "..." where it is wider or longer than 1000 bytes.
std::string fit_text(std::string_view text, double size_px, double width_px);

}  // namespace skinframe
