// SPDX-License-Identifier: GPL-3.0-or-later
// The valid model against CalculiX (ask_calculix.h) on frames and skins of bodies, 200 mm large, sampled by
// the pipeline's stages, each pushed sideways and down at its highest node.
//
// Compared, and how near: displacements of all nodes, by the root of the sum of their squares, and the work
// of each load.
//
//   frame alone, nu 0.35   0.2 %  struts of 1 mm; theirs do not contract across
//                          0.5 %  struts of the printer's least radius; isotropic
//   frame and skin, nu 0   2 %    struts of 1 mm
//
// With skin, all struts are full discs whose axes meet the nodes: CalculiX has no half discs (nothing of
// theirs is compared here, nor of their arms: eccentric_rib_test.cpp has a closed form). Either program
// divides the same flat triangles, so that it has the same nodes: corners and middles of its six-node shells
// are corners of our triangles. It bends shells with shear (Mindlin), which counts for little at a hundredth
// of their width.
//
// What stands is held as a part of the surface, its lowest fifth: on single nodes a shell gives way the more
// the finer its mesh is (Nefertiti on three of them some eighty times as far), and either program by what its
// own elements are.
//
// The tests are written once, in calculix_agreement.cpp; programs name their bodies.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>

namespace skinframe::test {

struct CalculixBody {
  std::string name;            // of one of the program's own bodies where no mesh is given
  std::filesystem::path mesh;  // its largest edge becomes 200 mm
};
inline std::ostream& operator<<(std::ostream& out, const CalculixBody& body) { return out << body.name; }

class CalculixAgreement : public testing::TestWithParam<CalculixBody> {};

inline std::string short_name(const testing::TestParamInfo<CalculixBody>& tested) {
  return tested.param.name.substr(0, 4);
}

}  // namespace skinframe::test
