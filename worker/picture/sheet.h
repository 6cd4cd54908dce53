// SPDX-License-Identifier: GPL-3.0-or-later
// The page of every picture: a title, a line below it, a place for the body, a colour bar. All sizes follow
// the picture's side.
#pragma once

#include <string>

#include "worker/raster/image.h"

namespace skinframe::picture {

struct Place {
  int x = 0, y = 0, width = 0, height = 0;  // in px
};

class Sheet {
 public:
  // Side and height in px; with_bar leaves room for a colour bar on the right.
  Sheet(int width_px, int height_px, const std::string& title, const std::string& below, bool with_bar);

  Place body() const { return body_; }
  double text_px() const { return text_px_; }
  Image& image() { return image_; }
  // A bar of the colour map with its numbers; `unit` stands above it. low <= high.
  void colour_bar(double low, double high, const std::string& unit);
  // A small square of a colour and what it stands for, in the lower left corner; each further one above it.
  void legend(Colour colour, const std::string& meaning);

 private:
  Image image_;
  double text_px_;
  Place body_;
  int legends_ = 0;
};

// Between 3 and 8 even numbers (1, 2 or 5 times a power of ten apart) within [low, high]; the numbers'
// spacing.
double tick_step(double low, double high);
// Without zeros behind the last digit that `step` asks for.
std::string tick_text(double value, double step);

}  // namespace skinframe::picture
