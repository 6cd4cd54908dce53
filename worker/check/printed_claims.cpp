// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "worker/check/claims.h"

namespace skinframe::check {

void claim_printed_struts(const ExportedPrinter& result, const TriangleMesh& cavity, const Surface& outer,
                          Verdict* verdict) {
  if (cavity.triangles.empty()) return;  // all is solid
  TriangleMesh outward = cavity;  // the cavity's boundary looks into the cavity; turned, it encloses it
  for (auto& t : outward.triangles) std::swap(t[1], t[2]);
  const Surface hollow(outward);

  std::vector<Eigen::Vector3d> nodes = result.frame.nodes_mm;
  std::vector<ExportedStrut> struts = result.frame.struts;
  if (result.supports) {
    for (const ExportedSupportNode& node : result.supports->nodes) nodes.push_back(node.at_mm);
    for (const ExportedSupportStrut& s : result.supports->struts)
      if (!s.external) struts.push_back({s.upper, s.lower, false, s.radius_mm, 0, 0});
  }

  // A level set rounds off less than a voxel; the middle of a strut stays solid.
  std::size_t looked_at = 0, missing = 0;
  double worst = std::numeric_limits<double>::infinity();
  for (const ExportedStrut& s : struts) {
    const Eigen::Vector3d &a = nodes[s.a], &b = nodes[s.b];
    bool judged = false, absent = false;
    for (const double t : {0.3, 0.5, 0.7}) {
      const Eigen::Vector3d p = a + t * (b - a);
      if (outer.depth_mm(p) < result.skin_thickness_mm) continue;
      judged = true;
      const double material_mm = -hollow.depth_mm(p);  // to the nearest void
      worst = std::min(worst, material_mm / s.radius_mm);
      absent |= material_mm < s.radius_mm - result.voxel_mm;
    }
    looked_at += judged ? 1 : 0;
    missing += absent ? 1 : 0;
  }
  if (looked_at == 0) {
    verdict->notes.push_back("no strut's axis runs below the skin: none could be looked for in the mesh");
    return;
  }
  verdict->claims.push_back({"struts are printed", missing == 0,
                             fmt::format("{} of {} struts looked at are not solid about their axis to their "
                                         "radius less a voxel of {:.3f} mm; the "
                                         "thinnest is {:.2f} of its radius",
                                         missing, looked_at, result.voxel_mm, worst)});
}

}  // namespace skinframe::check
