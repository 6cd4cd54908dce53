// SPDX-License-Identifier: GPL-3.0-or-later
// Fairing without shrinking (Taubin, "A Signal Processing Approach to Fair Surface Design", 1995).
//
//     x <- x + lambda L x,   x <- x + mu L x,   L x_i = mean of the neighbours of i - x_i
// with lambda = 0.5, mu = -0.53, so the pass band ends at 1 / lambda + 1 / mu = 0.113. On a mesh of edges
// about e a wave of length w has the eigenvalue (pi e / w)^2: waves longer than 9.3 e stay, those of 5 e fall
// to two fifths in 30 pairs of steps, those of 3 e vanish. So the mesh should be even, and e says what goes.
#pragma once

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

inline constexpr double kTaubinLambda = 0.5;
inline constexpr double kTaubinMu = -0.53;

// The connections stay. Corners without a neighbour stay where they are.
void fair_taubin(TriangleMesh& closed_mesh, int pairs);

}  // namespace skinframe
