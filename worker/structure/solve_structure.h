// SPDX-License-Identifier: GPL-3.0-or-later
// K D = F of a structure: assembled once, factorised by CHOLMOD (supernodal), any number of load cases at
// once.
#pragma once

#include <Eigen/SparseCore>
#include <memory>

#include "worker/run/run_context.h"
#include "worker/structure/structure.h"

namespace skinframe {

inline constexpr std::size_t kMaxStructureNodes = 100000;
inline constexpr double kBalanceTolerance = 1e-8;  // relative, of reactions against what acts

struct Balance {
  double force = 0;   // |sum of forces and reactions| over the sum of the forces' sizes
  double moment = 0;  // the same about the middle of the nodes, over sizes times the extent
};

class StructureSolver {
 public:
  // The structure is checked and kept by reference: it must outlive the solver. Nodes that nothing joins stay
  // where they are. Errors: kInvalidInput when an invariant does not hold, when there are more nodes than
  // kMaxStructureNodes, or when the structure is not held (a pivot is not positive); kCancelled.
  static Result<StructureSolver> factorise(const Structure& structure, const RunContext& context);
  ~StructureSolver();
  StructureSolver(StructureSolver&&) noexcept;

  const Structure& structure() const;

  // Displacements and rotations of all nodes; held ones are zero, and forces on them go into the support.
  NodalColumns solve(const NodalColumns& loads_n) const;
  // One step of iterative refinement, D <- D + K^-1 (F - K D): where stiff slivers beside soft parts cost
  // digits.
  void refine(const NodalColumns& loads_n, NodalColumns* displacements) const;
  // What the supports do to the structure: K D - F at held freedoms, zero elsewhere.
  NodalColumns reactions_n(const NodalColumns& displacements, const NodalColumns& loads_n) const;
  // |K D - F| over |F| at free freedoms, largest entries.
  double residual(const NodalColumns& displacements, const NodalColumns& loads_n) const;
  // Worst over the load cases: reactions against loads.
  Balance balance(const NodalColumns& displacements, const NodalColumns& loads_n) const;

  // For eigenvalue problems on the free freedoms: x <- K x, and the halves of K^-1 = H^T H: x <- H x and
  // x <- H^T x. (H = L^-1 P, for the factor L of K with its rows and columns in CHOLMOD's order P.)
  int free_count() const;
  Eigen::VectorXd multiply_free(const Eigen::VectorXd& x) const;
  Eigen::VectorXd half_solve_free(const Eigen::VectorXd& x) const;
  Eigen::VectorXd other_half_solve_free(const Eigen::VectorXd& x) const;
  int free_index(int node, int freedom) const;  // -1: held, or joined to nothing

 private:
  struct Impl;
  explicit StructureSolver(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace skinframe
