// SPDX-License-Identifier: GPL-3.0-or-later
// A structure asked of CalculiX (ccx), which knows nothing of our elements, as a process.
//
// It takes shells and beams as what they are made of: a six-node shell (S6) becomes a quadratic wedge, a
// three-node beam (B32R) a quadratic brick, and where they meet it makes their cross sections rigid. A shell
// becomes one S6, the middles of its sides halfway between its corners; a strut along a side of a shell one
// B32R on the same three nodes, any other strut two or four of them.
//
// Full discs are pipes whose wall is their radius: the integration points of PIPE give the disc's area and
// inertia exactly, where CIRC's section, drawn with parabolas, bends 2 % too easily, and B32's cannot be a
// pipe. (The one element of CalculiX that is a beam by itself, U1, takes shear away where it has to add it,
// and bends wrongly about its second axis where two of them meet, in release 2.20.)
#pragma once

#include "worker/structure/structure.h"

namespace skinframe::test {

// A rigid cross section cannot contract across, as a bar or a shell with nu > 0 does, so near to its ends a
// bar of bricks is too stiff, by more the thicker it is for its length.
enum class Contraction {
  kNone,       // the struts' material is orthotropic along each of them: no contraction across, the shear
               // modulus of its own nu, which is all that a beam knows of it; two beams a strut. Shells are
               // to be compared at nu = 0
  kIsotropic,  // the material as it is: four beams a strut, those at its ends as long as its radius. For
               // structures without shells
};

// One column a load case, three rows a node of the structure: displacements. Forces alone are taken from the
// loads, which have six rows a node; middles between two held nodes are held. Struts have to be full discs
// without arms. The test fails, and nothing is returned, where ccx has no answer.
Eigen::MatrixXd ask_calculix(const Structure& structure, const NodalColumns& loads_n,
                             Contraction contraction = Contraction::kNone);

}  // namespace skinframe::test
