// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of bodies: the frame, the printed solid cut open, a deformed surface. All are seen from before
// their longer horizontal side, a little from the side and from above.
#pragma once

#include <string>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/picture/exported_frame.h"
#include "worker/raster/image.h"

namespace skinframe::picture {

inline constexpr int kLeastSidePx = 120, kMostSidePx = 4096;

// Struts as round rods coloured by radius, with a colour bar; supports in red.
Image frame_picture(const DrawnFrame& frame, const std::string& title, int side_px);

// The half before the body's middle is taken away; what the cut meets is filled in red, the skin's inside and
// the frame behind it are seen. The mesh is closed and has its outside out, as what is exported is.
Image cutaway_picture(const TriangleMesh& mesh, const std::string& title, int side_px);

// A surface in the colours of its vertices, one each.
Image coloured_picture(const TriangleMesh& mesh, const std::vector<Colour>& vertex_colours,
                       const std::string& title, const std::string& below, int side_px);

}  // namespace skinframe::picture
