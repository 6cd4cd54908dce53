// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/lump_skin.h"

#include "worker/frame/vertex_graph.h"

namespace skinframe {

std::vector<double> lump_skin_volume_mm3(const Frame& frame, const Skin& skin) {
  std::vector<double> share = vertex_areas({frame.nodes_mm, frame.skin_triangles});
  double area = 0.0;
  for (double a : share) area += a;
  if (!(area > 0.0)) return std::vector<double>(share.size(), 0.0);
  for (double& s : share) s *= skin.volume_mm3 / area;
  return share;
}

}  // namespace skinframe
