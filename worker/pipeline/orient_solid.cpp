// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/orient_solid.h"

#include <algorithm>

#include "worker/pipeline/fits_tray.h"
#include "worker/solid/place.h"
#include "worker/support/orient_body.h"

namespace skinframe {

Result<OrientedSolid> orient_solid(const Solid& solid, const JobRequest& request) {
  OrientedSolid out{solid, {}};
  const auto extrusion =
      std::find_if(request.printers.begin(), request.printers.end(), [](const PrinterRequest& printer) {
        return printer.printer.process == PrintProcess::kExtrusion && printer.printer.printable_length;
      });
  if (extrusion == request.printers.end()) return out;
  out.facts.printer = extrusion->printer.id;
  OrientOptions options;
  options.min_radius_mm = extrusion->printer.min_radius_mm;
  options.slenderness = extrusion->material.slenderness;
  options.skin_thickness_mm = extrusion->printer.skin_thickness_mm();
  bool chosen = false;
  for (const Attitude& attitude :
       rank_attitudes(solid.mesh(), *extrusion->printer.printable_length, options)) {
    const bool own = attitude.rotation.isIdentity();
    OrientationFacts::Tried tried{attitude.rotation, attitude.support_mm3, attitude.margin_mm};
    ++out.facts.candidates;
    if (chosen) {
      if (!out.facts.runner_up) out.facts.runner_up = tried;
      continue;
    }
    if (!own) {
      TriangleMesh turned = solid.mesh();
      for (Eigen::Vector3d& v : turned.vertices) v = attitude.rotation * v;
      auto made = Solid::make(put_on_plate(std::move(turned)));
      const bool fits = made && std::all_of(request.printers.begin(), request.printers.end(),
                                            [&](const auto& p) { return fits_tray(*made, p.printer).ok(); });
      if (!fits) {
        ++out.facts.passed_over;
        continue;
      }
      out.solid = std::move(made).value();
    }
    out.facts.chosen = tried;
    chosen = true;
  }
  return out;
}

}  // namespace skinframe
