// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mechanics/equilibrium.h"

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>
#include <numeric>

#include "worker/mechanics/strut_element.h"
#include "worker/run/ordering_turn.h"

namespace skinframe {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr int kRefinements = 3;
constexpr double kRefinedEnough = 1e-13;  // relative residual

Vector3d strut_vector(const Frame& frame, int j) {
  const Strut& strut = frame.struts[j];
  return frame.nodes_mm[strut.b] - frame.nodes_mm[strut.a];
}

}  // namespace

NodeVectors nodal_loads_n(const FrameProblem& problem, const std::vector<double>& areas_mm2, int load_case) {
  const LoadCase& load = problem.load_cases[load_case];
  NodeVectors loads = load.force_n;
  if (!load.gravity) return loads;
  for (std::size_t i = 0; i < problem.skin_weight_n.size(); ++i) loads[i].z() -= problem.skin_weight_n[i];
  const double half_weight = problem.material.weight_density_n_mm3() / 2;
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j) {
    const Strut& strut = problem.frame.struts[j];
    const double weight = half_weight * areas_mm2[j] * problem.frame.length_mm(strut);
    loads[strut.a].z() -= weight;
    loads[strut.b].z() -= weight;
  }
  return loads;
}

// K lives on the free axes only; lower triangle. slots_ says where each strut's 6 x 6 block adds up.
struct EquilibriumSolver::Impl {
  const FrameProblem& problem;
  StrutSprings springs;
  std::vector<std::array<int, 3>> unknown;  // of each node's axes; -1 where fixed
  int unknowns = 0;
  SparseMatrix stiffness;
  std::vector<std::array<int, 36>> slots;  // into stiffness.valuePtr(); -1 above the diagonal or fixed
  std::vector<int> diagonal;               // slot of each unknown's diagonal
  Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> factor;

  explicit Impl(const FrameProblem& p) : problem(p), springs(strut_springs(p.element, p.material)) {
    number_unknowns();
    build_pattern();
    factor.cholmod().print = 0;  // failure is a return value, not a line on the terminal
    if (unknowns == 0) return;
    const OrderingTurn turn;
    factor.analyzePattern(stiffness);
  }

  void number_unknowns() {
    unknown.assign(problem.frame.nodes_mm.size(), {-1, -1, -1});
    for (std::size_t i = 0; i < unknown.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (!problem.fixed[i][axis]) unknown[i][axis] = unknowns++;
  }

  int unknown_of(const Strut& strut, int local) const {
    return local < 3 ? unknown[strut.a][local] : unknown[strut.b][local - 3];
  }

  void build_pattern() {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(21 * problem.frame.struts.size() + unknowns);
    for (int u = 0; u < unknowns; ++u) entries.emplace_back(u, u, 0.0);
    for (const Strut& strut : problem.frame.struts)
      for (int c = 0; c < 6; ++c)
        for (int r = 0; r < 6; ++r) {
          const int row = unknown_of(strut, r), column = unknown_of(strut, c);
          if (column >= 0 && row >= column) entries.emplace_back(row, column, 0.0);
        }
    stiffness.resize(unknowns, unknowns);
    stiffness.setFromTriplets(entries.begin(), entries.end());
    stiffness.makeCompressed();

    for (int u = 0; u < unknowns; ++u) diagonal.push_back(slot(u, u));
    slots.resize(problem.frame.struts.size());
    for (std::size_t j = 0; j < slots.size(); ++j)
      for (int c = 0; c < 6; ++c)
        for (int r = 0; r < 6; ++r) {
          const int row = unknown_of(problem.frame.struts[j], r),
                    column = unknown_of(problem.frame.struts[j], c);
          slots[j][6 * c + r] = column >= 0 && row >= column ? slot(row, column) : -1;
        }
  }

  int slot(int row, int column) const {
    const int* begin = stiffness.innerIndexPtr() + stiffness.outerIndexPtr()[column];
    const int* end = stiffness.innerIndexPtr() + stiffness.outerIndexPtr()[column + 1];
    return static_cast<int>(std::lower_bound(begin, end, row) - stiffness.innerIndexPtr());
  }

  void assemble(const std::vector<double>& areas_mm2) {
    std::fill_n(stiffness.valuePtr(), stiffness.nonZeros(), 0.0);
    for (std::size_t j = 0; j < slots.size(); ++j) {
      const Matrix3d b =
          areas_mm2[j] * strut_stiffness(springs, strut_vector(problem.frame, static_cast<int>(j)));
      for (int c = 0; c < 6; ++c)
        for (int r = 0; r < 6; ++r)
          if (const int at = slots[j][6 * c + r]; at >= 0)
            stiffness.valuePtr()[at] += (r < 3) == (c < 3) ? b(r % 3, c % 3) : -b(r % 3, c % 3);
    }
  }

  bool factorise() {
    double largest = 0;
    for (int at : diagonal) largest = std::max(largest, stiffness.valuePtr()[at]);
    const double shift = largest > 0 ? kRegularisation * largest : 1.0;
    SparseMatrix shifted = stiffness;
    for (int at : diagonal) shifted.valuePtr()[at] += shift;
    factor.factorize(shifted);
    if (factor.cholmod().status < CHOLMOD_OK) throw std::bad_alloc();  // which Eigen does not see
    return factor.info() == Eigen::Success;
  }

  VectorXd gather(const NodeVectors& vectors) const {
    VectorXd packed(unknowns);
    for (std::size_t i = 0; i < unknown.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (unknown[i][axis] >= 0) packed[unknown[i][axis]] = vectors[i][axis];
    return packed;
  }

  CaseResponse respond(const std::vector<double>& areas_mm2, int load_case, bool factorised) const {
    CaseResponse response;
    const NodeVectors loads = nodal_loads_n(problem, areas_mm2, load_case);
    const VectorXd f = gather(loads);
    VectorXd d = VectorXd::Zero(unknowns);
    double residual = unknowns > 0 ? f.lpNorm<Eigen::Infinity>() : 0;
    const double scale = std::max(residual, std::numeric_limits<double>::min());
    for (int pass = 0; factorised && pass <= kRefinements && residual > kRefinedEnough * scale; ++pass) {
      const VectorXd refined = d + VectorXd(factor.solve(f - stiffness.selfadjointView<Eigen::Lower>() * d));
      const double left = (f - stiffness.selfadjointView<Eigen::Lower>() * refined).lpNorm<Eigen::Infinity>();
      if (pass > 0 && !(left < residual)) break;
      d = refined;
      residual = left;
    }
    response.residual = residual / scale;
    response.in_equilibrium = response.residual <= kResidualLimit && d.allFinite();

    response.displacements_mm.assign(unknown.size(), Vector3d::Zero());
    for (std::size_t i = 0; i < unknown.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis)
        if (unknown[i][axis] >= 0) response.displacements_mm[i][axis] = d[unknown[i][axis]];
      response.max_displacement_mm =
          std::max(response.max_displacement_mm, response.displacements_mm[i].norm());
    }
    add_strut_forces(areas_mm2, loads, response);
    return response;
  }

  void add_strut_forces(const std::vector<double>& areas_mm2, const NodeVectors& loads,
                        CaseResponse& response) const {
    NodeVectors balance = loads;  // load - internal force: minus the reaction
    const std::size_t struts = problem.frame.struts.size();
    response.axial_stress_mpa.resize(struts);
    response.shear_stress_mpa.resize(struts);
    for (std::size_t j = 0; j < struts; ++j) {
      const Strut& strut = problem.frame.struts[j];
      const Vector3d e = strut_vector(problem.frame, static_cast<int>(j));
      const Vector3d delta = response.displacements_mm[strut.b] - response.displacements_mm[strut.a];
      const double l = e.norm(), along = e.dot(delta) / l;
      response.axial_stress_mpa[j] = springs.axial * along / l;
      response.shear_stress_mpa[j] = springs.shear * (delta - along / l * e).norm() / l;
      const Vector3d force = areas_mm2[j] * (strut_stiffness(springs, e) * delta);
      balance[strut.a] += force;
      balance[strut.b] -= force;
    }
    response.reactions_n.assign(unknown.size(), Vector3d::Zero());
    for (std::size_t i = 0; i < unknown.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (unknown[i][axis] < 0) response.reactions_n[i][axis] = -balance[i][axis];
  }
};

EquilibriumSolver::EquilibriumSolver(const FrameProblem& problem) : impl_(std::make_unique<Impl>(problem)) {}
EquilibriumSolver::~EquilibriumSolver() = default;
EquilibriumSolver::EquilibriumSolver(EquilibriumSolver&&) noexcept = default;

std::vector<CaseResponse> EquilibriumSolver::solve(const std::vector<double>& areas_mm2) {
  std::vector<int> all(impl_->problem.load_cases.size());
  std::iota(all.begin(), all.end(), 0);
  return solve(areas_mm2, all);
}

std::vector<CaseResponse> EquilibriumSolver::solve(const std::vector<double>& areas_mm2,
                                                   const std::vector<int>& cases) {
  SKINFRAME_CHECK(areas_mm2.size() == impl_->problem.frame.struts.size());
  impl_->assemble(areas_mm2);
  const bool factorised = impl_->unknowns == 0 || impl_->factorise();
  std::vector<CaseResponse> responses;
  responses.reserve(cases.size());
  for (int k : cases) responses.push_back(impl_->respond(areas_mm2, k, factorised));
  return responses;
}

std::vector<CaseResponse> solve_equilibrium(const FrameProblem& problem,
                                            const std::vector<double>& areas_mm2) {
  return EquilibriumSolver(problem).solve(areas_mm2);
}

std::vector<double> areas_of(const std::vector<double>& radii_mm) {
  std::vector<double> areas(radii_mm.size());
  std::transform(radii_mm.begin(), radii_mm.end(), areas.begin(),
                 [](double r) { return std::numbers::pi * r * r; });
  return areas;
}

std::vector<double> radii_of(const std::vector<double>& areas_mm2) {
  std::vector<double> radii(areas_mm2.size());
  std::transform(areas_mm2.begin(), areas_mm2.end(), radii.begin(),
                 [](double a) { return std::sqrt(std::max(a, 0.0) / std::numbers::pi); });
  return radii;
}

}  // namespace skinframe
