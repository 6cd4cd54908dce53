// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/fits_tray.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

namespace skinframe {
namespace {

// Absolute: a solid's coordinates are floats, and a body of the tray's very size fits.
constexpr double kRoundingMm = 1e-3;

}  // namespace

Status fits_tray(const Solid& solid, const PrinterProfile& printer) {
  const Eigen::Vector3d size = solid.box().extent();
  Eigen::Vector3d tray = printer.tray_mm;
  // The longer side of the one along the longer side of the other: where that does not fit, neither does the
  // other way.
  const bool turned = (size.x() > size.y()) != (tray.x() > tray.y());
  if (turned) std::swap(tray.x(), tray.y());
  std::string excess;
  for (int k = 0; k < 3; ++k) {
    if (size[k] - tray[k] <= kRoundingMm) continue;
    excess += fmt::format("{}{:.1f} mm too {} in {}", excess.empty() ? "" : ", ", size[k] - tray[k],
                          k == 2 ? "high" : "long", "xyz"[k]);
  }
  if (excess.empty()) return ok_status();
  const double largest_size = size.maxCoeff() * (tray.array() / size.array()).minCoeff();
  return Error{
      ErrorKind::kDoesNotFit,
      fmt::format(
          "{:.1f} x {:.1f} x {:.1f} mm does not fit the tray of {} ({:g} x {:g} x {:g} mm){}: {}; use "
          "--size {:g} or less",
          size.x(), size.y(), size.z(), printer.id, printer.tray_mm.x(), printer.tray_mm.y(),
          printer.tray_mm.z(), turned ? ", turned about z" : "", excess, std::floor(largest_size))};
}

}  // namespace skinframe
