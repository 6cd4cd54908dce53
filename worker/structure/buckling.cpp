// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/buckling.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

// Lanczos' three-term recurrence for K^-1 A, A = -K_g, in the inner product of K. Since K (K^-1 A v) = A v is
// at hand before the solve, K v is carried along with v and K itself is never multiplied. No vector is
// orthogonalised again: lost orthogonality repeats eigenvalues that have converged, and the largest is all
// that is asked for (Paige, "Error analysis of the Lanczos algorithm for tridiagonalizing a symmetric
// matrix", J. Inst. Maths Applics 18, 1976).
class Lanczos {
 public:
  // start: any vector; solved: K^-1 start.
  Lanczos(SparseMatrix compression, const VectorXd& start, const VectorXd& solved)
      : compression_(std::move(compression)) {
    const double size = std::sqrt(solved.dot(start));
    v_ = solved / size;
    kv_ = start / size;
    before_ = kbefore_ = VectorXd::Zero(v_.size());
  }

  bool done() const { return done_; }
  std::optional<double> largest() const { return largest_; }  // mu or 0; none: not converged yet

  VectorXd next_load() {
    q_ = compression_ * v_;
    return q_;
  }

  // solved: K^-1 of the load.
  void step(VectorXd solved) {
    alpha_.push_back(v_.dot(q_));
    const double beta = beta_.empty() ? 0 : beta_.back();
    solved -= alpha_.back() * v_ + beta * before_;
    q_ -= alpha_.back() * kv_ + beta * kbefore_;
    const double square = solved.dot(q_), next = square > 0 ? std::sqrt(square) : 0;
    beta_.push_back(next);
    if (next == 0 || alpha_.size() < kStepsAllChecked || alpha_.size() % kStepsAChecked == 0) check(next);
    if (done_) return;
    before_.swap(v_);
    kbefore_.swap(kv_);
    v_ = solved / next;
    kv_ = q_ / next;
  }

 private:
  static constexpr std::size_t kStepsAllChecked = 16, kStepsAChecked = 4;
  static constexpr double kNothing = 1e-6;  // of the largest |mu|, that of the load reversed included

  // The residual of the largest Ritz value is beta times the last entry of its vector.
  void check(double beta) {
    const auto m = static_cast<Eigen::Index>(alpha_.size());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
    ritz.computeFromTridiagonal(Eigen::Map<const VectorXd>(alpha_.data(), m),
                                Eigen::Map<const VectorXd>(beta_.data(), m - 1));
    const double mu = ritz.eigenvalues()[m - 1], scale = ritz.eigenvalues().cwiseAbs().maxCoeff();
    const double residual = beta * std::abs(ritz.eigenvectors()(m - 1, m - 1));
    if (ritz.info() != Eigen::Success ||
        residual > kBucklingTolerance * std::max(std::abs(mu), kNothing * scale))
      return;
    done_ = true;
    largest_ = mu > kNothing * scale ? mu : 0;
  }

  SparseMatrix compression_;
  VectorXd v_, kv_, before_, kbefore_, q_;
  std::vector<double> alpha_, beta_;
  bool done_ = false;
  std::optional<double> largest_;
};

VectorXd any_vector(int size) {
  std::mt19937 random(1);
  VectorXd x(size);
  for (double& entry : x) entry = static_cast<double>(random()) / std::mt19937::max() - 0.5;
  return x;
}

}  // namespace

Result<std::vector<std::optional<double>>> buckling_factors(const StructureSolver& solver,
                                                            const NodalColumns& displacements) {
  constexpr int kMostSteps = 600;
  const int n = solver.free_count();
  std::vector<std::optional<double>> factors(displacements.cols());
  if (n == 0) return factors;
  const VectorXd start = any_vector(n), solved = solver.solve_free(start);
  std::vector<Lanczos> runs;
  std::vector<std::size_t> open, case_of;  // runs that go on; the case of each run
  for (Eigen::Index c = 0; c < displacements.cols(); ++c) {
    SparseMatrix geometric = geometric_stiffness(solver, displacements.col(c));
    if (!(geometric.squaredNorm() > 0)) continue;
    open.push_back(runs.size());
    case_of.push_back(c);
    runs.emplace_back(-geometric, start, solved);
  }
  for (int step = 0; step < kMostSteps && !open.empty(); ++step) {
    Eigen::MatrixXd loads(n, static_cast<Eigen::Index>(open.size()));
    for (std::size_t k = 0; k < open.size(); ++k) loads.col(k) = runs[open[k]].next_load();
    const Eigen::MatrixXd answers = solver.solve_free(loads);
    for (std::size_t k = 0; k < open.size(); ++k) runs[open[k]].step(answers.col(k));
    std::erase_if(open, [&](std::size_t run) { return runs[run].done(); });
  }
  if (!open.empty()) return internal_error("the buckling factor does not converge");
  for (std::size_t run = 0; run < runs.size(); ++run)
    if (const double mu = *runs[run].largest(); mu > 0) factors[case_of[run]] = 1 / mu;
  return factors;
}

Result<std::optional<double>> buckling_factor(const StructureSolver& solver, const VectorXd& displacement) {
  auto factors = buckling_factors(solver, displacement);
  if (!factors) return factors.error();
  return factors->front();
}

double euler_load_n(double modulus_mpa, double least_inertia_mm4, double length_mm) {
  return std::numbers::pi * std::numbers::pi * modulus_mpa * least_inertia_mm4 / (length_mm * length_mm);
}

}  // namespace skinframe
