// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/write_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "worker/verify/coloured_skin.h"
#include "worker/verify/pinch.h"

namespace skinframe {
namespace {

double closing_near(const PinchFigures& pinch, const Eigen::Vector3d& p) {
  double closing = 0, nearest = std::numeric_limits<double>::infinity();
  for (const PinchedSite& site : pinch.sites)
    for (const Eigen::Vector3d& finger : site.fingers_mm)
      if (const double d = (finger - p).squaredNorm(); d < nearest) {
        nearest = d;
        closing = site.closing_mm;
      }
  return closing;
}

}  // namespace

Status write_deformation(const Verification& v, const Deformation& deformation,
                         const std::filesystem::path& path) {
  double most = 0;
  for (const auto& d : deformation.displacement_mm) most = std::max(most, d.norm());
  ColouredSkin coloured;
  coloured.comments = {"load " + deformation.name, fmt::format("red is {:.6g} mm", most)};
  coloured.names = {"displacement_x", "displacement_y", "displacement_z"};
  for (const auto& d : deformation.displacement_mm) {
    coloured.figures.push_back({d.x(), d.y(), d.z()});
    coloured.shares.push_back(most > 0 ? d.norm() / most : 0);
  }
  return write_coloured_skin(v, coloured, path);
}

Status write_pinch_map(const Verification& v, const std::filesystem::path& path) {
  SKINFRAME_CHECK(v.ours.pinch.has_value());
  const PinchFigures& pinch = *v.ours.pinch;
  ColouredSkin coloured;
  coloured.comments = {fmt::format("two fingers of {:g} N at {} sites, as at the nearest finger",
                                   kPinchForceN, pinch.sites.size()),
                       fmt::format("red is {:.6g} mm", pinch.max_mm)};
  coloured.names = {"closing"};
  for (const Eigen::Vector3d& p : v.skin_mm) {
    coloured.figures.push_back({closing_near(pinch, p)});
    coloured.shares.push_back(pinch.max_mm > 0 ? coloured.figures.back()[0] / pinch.max_mm : 0);
  }
  return write_coloured_skin(v, coloured, path);
}

}  // namespace skinframe
