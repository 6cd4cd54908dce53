// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra that fill {level < 0}: isosurface stuffing (Labelle, Shewchuk, "Isosurface Stuffing", ACM Trans.
// Graph. 26(3), 2007) on a uniform body-centred cubic lattice.
//
// Lattice points near to the surface are moved onto it, the tetrahedra of the lattice are cut there, and what
// is left inside is divided into tetrahedra; quadrilaterals by the diagonal at their least vertex, so that
// neighbours agree. The lattice's tetrahedra are nearly regular, 12 to a cube of spacing_mm.
//
// Guarantees:
//  1. Every tetrahedron has a volume of at least 1e-4 of a lattice tetrahedron's; every inner face has two.
//  2. Vertices of the cut surface lie on {level = 0} to spacing_mm / 1000 where level is continuous.
//  3. At most kMaxLatticeCells cells are looked at, decided before any memory is taken.
// What is thinner than about a spacing may be missed: compare volumes.
//
// Graded, the lattice is bisected first where it is asked to be finer (graded_lattice.h); its edges then pull
// no point further than 0.3 of the shortest one. Guarantee 1 is of each tetrahedron's longest edge there.
#pragma once

#include <functional>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"
#include "worker/stress/tet_mesh.h"

namespace skinframe {

inline constexpr double kMaxLatticeCells = 1e6;
inline constexpr int kTetsACell = 12;

// The least spacing that a bound on cells allows for a box.
double least_spacing_mm(const BoundingBox& box, double most_cells = kMaxLatticeCells);

// Errors: kInvalidInput for a spacing below least_spacing_mm(); kCancelled.
Result<TetMesh> fill_with_tetrahedra(const std::function<double(const Eigen::Vector3d&)>& level,
                                     const BoundingBox& box, double spacing_mm, const RunContext& context);

// finer_mm: the spacing wanted at a point; bisection ends at kMostGradedTets. Errors: kInvalidInput for a
// spacing below least_spacing_mm(box, kMostGradedCells); kCancelled.
inline constexpr double kMostGradedCells = 1e4;
inline constexpr std::size_t kMostGradedTets = 400000;
using SpacingAt = std::function<double(const Eigen::Vector3d&)>;
Result<TetMesh> fill_with_graded_tetrahedra(const std::function<double(const Eigen::Vector3d&)>& level,
                                            const BoundingBox& box, double spacing_mm,
                                            const SpacingAt& finer_mm, const RunContext& context);

}  // namespace skinframe
