// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and filled rectangles, smooth at their rims: a pixel takes the colour by how much of it is covered.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/raster/image.h"

namespace skinframe {

void fill_rectangle(Image& image, double x0, double y0, double x1, double y1, Colour colour);

// A polyline with round ends, each pixel blended once however often the line passes it.
void draw_polyline(Image& image, const std::vector<Eigen::Vector2d>& points_px, double width_px,
                   Colour colour);

}  // namespace skinframe
