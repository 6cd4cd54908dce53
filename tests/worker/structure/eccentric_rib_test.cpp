// SPDX-License-Identifier: GPL-3.0-or-later
// A rib off the mid-surface: a strip of shell with a half disc along its middle line, below it by its arm, as
// skin struts stand below the skin. By the parallel axis theorem, at nu = 0, with the rib's centroid c from
// the mid-surface and e that of both together:
//
//   EI = E (b t^3 / 12 + A_p e^2 + I_out + A_r (c - e)^2),  e = A_r c / (A_p + A_r)
//
// A tip load P bends the cantilever by P L^3 / (3 EI), turns its end by P L^2 / (2 EI), and the mid-surface's
// end moves along by e times that. What the formula leaves out, shear of the rib and of the strip in its own
// plane, counts for some thousandths at a width of a twentieth of the length.
#include <gtest/gtest.h>

#include "tests/worker/structure/grids.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using test::factorised;
using test::no_load;
using test::plate_grid;
using test::ShellGrid;

constexpr double pi = std::numbers::pi;
constexpr double kLengthMm = 160, kWidthMm = 8, kThicknessMm = 1, kRadiusMm = 2, kModulusMpa = 1586;
constexpr double kForceN = 0.1;

struct Tip {
  double down_mm = 0, along_mm = 0;  // means over the end of the mid-surface
};

// below: the side of the strip that the rib is on, 1 or -1.
Tip bent_strip(int cells_along, int cells_across, double below) {
  ShellGrid g = plate_grid(kLengthMm, kWidthMm, cells_along, cells_across, kThicknessMm, {kModulusMpa, 0});
  Structure& s = g.structure;
  for (int i = 0; i < cells_along; ++i) {
    StructureStrut rib;
    rib.nodes = {g.node(i, cells_across / 2), g.node(i + 1, cells_across / 2)};
    rib.shape = StrutShape::kHalfDisc;
    rib.arm = {Vector3d(0, 0, -below), Vector3d(0, 0, -below)};
    rib.arm_mm = kThicknessMm / 2;
    rib.radius_mm = kRadiusMm;
    s.struts.push_back(rib);
  }
  NodalColumns f = no_load(s);
  const auto share = [&](int j) { return (j == 0 || j == cells_across ? 0.5 : 1.0) / cells_across; };
  for (int j = 0; j <= cells_across; ++j) {
    s.held[g.node(0, j)] = kClamped;
    f(6 * g.node(cells_along, j) + 2, 0) = -kForceN * share(j);
  }
  const NodalColumns d = factorised(s).solve(f);
  Tip tip;
  for (int j = 0; j <= cells_across; ++j) {
    tip.down_mm -= share(j) * d(6 * g.node(cells_along, j) + 2, 0);
    tip.along_mm += share(j) * d(6 * g.node(cells_along, j), 0);
  }
  return tip;
}

struct Composite {
  double stiffness = 0, off_mm = 0;  // EI, N mm2; of the common centroid from the mid-surface
};

Composite composite() {
  const double strip = kWidthMm * kThicknessMm, rib = pi * kRadiusMm * kRadiusMm / 2;
  const double c = kThicknessMm / 2 + 4 * kRadiusMm / (3 * pi), e = rib * c / (strip + rib);
  const double own =
      kWidthMm * std::pow(kThicknessMm, 3) / 12 + (pi / 8 - 8 / (9 * pi)) * std::pow(kRadiusMm, 4);
  return {kModulusMpa * (own + strip * e * e + rib * (c - e) * (c - e)), e};
}

TEST(EccentricRib, BendsWithItsStripAsOneSection) {
  const Composite both = composite();
  const double down = kForceN * std::pow(kLengthMm, 3) / (3 * both.stiffness);
  const double along = both.off_mm * kForceN * kLengthMm * kLengthMm / (2 * both.stiffness);
  for (const double below : {1.0, -1.0}) {
    const Tip tip = bent_strip(80, 4, below);
    EXPECT_NEAR(tip.down_mm / down, 1, 0.005) << below;
    // The neutral layer lies on the rib's side: above it all is stretched when the tip goes down.
    EXPECT_NEAR(below * tip.along_mm / along, 1, 0.005) << below;
  }
}

}  // namespace
}  // namespace skinframe
