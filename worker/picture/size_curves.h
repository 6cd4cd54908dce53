// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's figure 5: how many struts are no thicker, or no longer, than so much, before and after each
// stage. Counts and not shares, so that the struts that a stage removes are seen as well.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "worker/picture/exported_frame.h"
#include "worker/raster/image.h"

namespace skinframe::picture {

enum class StrutSize { kRadius, kLength };

// The corners of the curve's steps: (value, how many values are <= it), from (0, 0) to (`end`, all).
std::vector<Eigen::Vector2d> cumulative(std::vector<double> values, double end);

// side_px wide and three quarters of it high.
Image curves_picture(const std::vector<StageSizes>& stages, StrutSize size, const std::string& title,
                     int side_px);

}  // namespace skinframe::picture
