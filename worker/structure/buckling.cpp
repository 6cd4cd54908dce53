// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/buckling.h"

#include <Spectra/SymGEigsSolver.h>

#include <algorithm>
#include <numbers>

namespace skinframe {
namespace {

using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

template <class Nodes, class Matrix>
void add_element(const StructureSolver& solver, const Nodes& nodes, const Matrix& k,
                 std::vector<Eigen::Triplet<double>>& entries) {
  for (int j = 0; j < k.cols(); ++j)
    for (int i = 0; i < k.rows(); ++i) {
      if (k(i, j) == 0) continue;
      const int row = solver.free_index(nodes[i / 6], i % 6), column = solver.free_index(nodes[j / 6], j % 6);
      if (row >= 0 && column >= 0) entries.emplace_back(row, column, k(i, j));
    }
}

SparseMatrix geometric_stiffness(const StructureSolver& solver, const VectorXd& displacement) {
  const Structure& s = solver.structure();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(s.shells.size() * 27 + s.struts.size() * 144);
  for (std::size_t i = 0; i < s.shells.size(); ++i) {
    const ShellTriangle shell = s.shell(i);
    const ShellStress stress = shell_stress(shell, s.material, freedoms_of(s.shells[i], displacement));
    add_element(solver, s.shells[i].nodes, shell_geometric_stiffness(shell, stress.membrane_mpa), entries);
  }
  for (std::size_t j = 0; j < s.struts.size(); ++j) {
    const RigidStrut strut = s.strut(j);
    const StrutStress stress = rigid_strut_stress(strut, s.material, freedoms_of(s.struts[j], displacement));
    add_element(solver, s.struts[j].nodes, rigid_strut_geometric_stiffness(strut, stress.axial_force_n),
                entries);
  }
  SparseMatrix k(solver.free_count(), solver.free_count());
  k.setFromTriplets(entries.begin(), entries.end());
  return k;
}

// -K_g as Spectra's A.
class Compression {
 public:
  using Scalar = double;
  explicit Compression(SparseMatrix geometric) : geometric_(std::move(geometric)) {}
  Eigen::Index rows() const { return geometric_.rows(); }
  Eigen::Index cols() const { return geometric_.cols(); }
  void perform_op(const double* in, double* out) const {
    VectorXd::Map(out, rows()).noalias() = -(geometric_ * VectorXd::Map(in, rows()));
  }

 private:
  SparseMatrix geometric_;
};

// K as Spectra's B: its halves serve, K itself is never multiplied.
class Stiffness {
 public:
  using Scalar = double;
  explicit Stiffness(const StructureSolver& solver) : solver_(solver) {}
  Eigen::Index rows() const { return solver_.free_count(); }
  Eigen::Index cols() const { return rows(); }
  void lower_triangular_solve(const double* in, double* out) const {
    VectorXd::Map(out, rows()) = solver_.half_solve_free(VectorXd::Map(in, rows()));
  }
  void upper_triangular_solve(const double* in, double* out) const {
    VectorXd::Map(out, rows()) = solver_.other_half_solve_free(VectorXd::Map(in, rows()));
  }

 private:
  const StructureSolver& solver_;
};

}  // namespace

Result<std::optional<double>> buckling_factor(const StructureSolver& solver, const VectorXd& displacement) {
  constexpr int kBasis = 24, kMostRestarts = 60;
  constexpr double kNothing = 1e-9;  // a factor of a billion is rounding
  const int n = solver.free_count();
  SparseMatrix geometric = geometric_stiffness(solver, displacement);
  if (n < 3 || !(geometric.squaredNorm() > 0)) return std::optional<double>();
  try {
    Compression compression(std::move(geometric));
    Stiffness stiffness(solver);
    Spectra::SymGEigsSolver<Compression, Stiffness, Spectra::GEigsMode::Cholesky> eigen(
        compression, stiffness, 1, std::min(n, kBasis));
    eigen.init();
    eigen.compute(Spectra::SortRule::LargestAlge, kMostRestarts, kBucklingTolerance,
                  Spectra::SortRule::LargestAlge);
    if (eigen.info() != Spectra::CompInfo::Successful)
      return internal_error("the buckling factor does not converge");
    const double mu = eigen.eigenvalues()[0];
    return mu > kNothing ? std::optional(1 / mu) : std::nullopt;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return internal_error(std::string("the buckling factor could not be computed: ") + e.what());
  }
}

double euler_load_n(double modulus_mpa, double least_inertia_mm4, double length_mm) {
  return std::numbers::pi * std::numbers::pi * modulus_mpa * least_inertia_mm4 / (length_mm * length_mm);
}

}  // namespace skinframe
