// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/solve_structure.h"

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Geometry>
#include <algorithm>
#include <new>

#include "worker/run/ordering_turn.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

// The lower half of all freedoms, held ones included.
template <class Nodes, class Matrix>
void add_element(const Nodes& nodes, const Matrix& k, Triplets& entries) {
  for (int j = 0; j < k.cols(); ++j)
    for (int i = 0; i < k.rows(); ++i) {
      const int row = 6 * nodes[i / 6] + i % 6, column = 6 * nodes[j / 6] + j % 6;
      if (row >= column) entries.emplace_back(row, column, k(i, j));
    }
}

SparseMatrix assemble(const Structure& s) {
  Triplets entries;
  entries.reserve(s.shells.size() * 189 + s.struts.size() * 93);
  for (std::size_t i = 0; i < s.shells.size(); ++i)
    add_element(s.shells[i].nodes, shell_stiffness(s.shell(i), s.material), entries);
  for (std::size_t j = 0; j < s.struts.size(); ++j)
    add_element(s.struts[j].nodes, rigid_strut_stiffness(s.strut(j), s.material), entries);
  const auto size = 6 * static_cast<Eigen::Index>(s.nodes_mm.size());
  SparseMatrix k(size, size);
  k.setFromTriplets(entries.begin(), entries.end());
  return k;
}

template <std::size_t N, class Matrix>
void add_forces(const std::vector<Vector3d>& at_mm, const std::array<int, N>& nodes, const Matrix& k,
                const NodalColumns& d, NodalColumns* forces) {
  Eigen::Matrix<double, 6 * N, Eigen::Dynamic> own(6 * N, d.cols());
  Vector3d middle = Vector3d::Zero();
  for (const int v : nodes) middle += at_mm[v] / N;
  for (std::size_t i = 0; i < N; ++i)
    own.template middleRows<6>(6 * i) = d.template middleRows<6>(6 * nodes[i]);
  for (Eigen::Index c = 0; c < d.cols(); ++c) {
    Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t i = 0; i < N; ++i) mean += own.col(c).template segment<6>(6 * i) / N;
    const Vector3d turn = mean.template tail<3>();
    for (std::size_t i = 0; i < N; ++i) {
      own.col(c).template segment<3>(6 * i) -= mean.template head<3>() + turn.cross(at_mm[nodes[i]] - middle);
      own.col(c).template segment<3>(6 * i + 3) -= turn;
    }
  }
  const Eigen::Matrix<double, 6 * N, Eigen::Dynamic> f = k * own;
  for (std::size_t i = 0; i < N; ++i)
    forces->template middleRows<6>(6 * nodes[i]) += f.template middleRows<6>(6 * i);
}

// Eigen's wrapper, which solves by the whole factor, with solves by its parts.
class Factor : public Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> {
 public:
  VectorXd solve_part(int system, VectorXd x) {
    cholmod_dense right = Eigen::viewAsCholmod(x);
    cholmod_dense* solved = cholmod_solve(system, m_cholmodFactor, &right, &cholmod());
    if (solved == nullptr) throw std::bad_alloc();
    x = VectorXd::Map(static_cast<const double*>(solved->x), x.size());
    cholmod_free_dense(&solved, &cholmod());
    return x;
  }
};

}  // namespace

struct StructureSolver::Impl {
  explicit Impl(const Structure& s) : structure(s) {}

  const Structure& structure;
  SparseMatrix held_removed;  // lower half, free freedoms only
  std::vector<int> place;     // of a freedom among the free ones, -1
  int free = 0;
  Factor factor;

  void number_freedoms() {
    const std::size_t n = structure.nodes_mm.size();
    std::vector<char> joined(n, 0);
    for (const auto& shell : structure.shells)
      for (const int v : shell.nodes) joined[v] = 1;
    for (const auto& strut : structure.struts)
      for (const int v : strut.nodes) joined[v] = 1;
    place.assign(6 * n, -1);
    for (std::size_t i = 0; i < 6 * n; ++i)
      if (joined[i / 6] && !structure.held[i / 6][i % 6]) place[i] = free++;
  }

  void remove_held(const SparseMatrix& whole) {
    Triplets entries;
    entries.reserve(whole.nonZeros());
    for (int c = 0; c < whole.outerSize(); ++c)
      for (SparseMatrix::InnerIterator it(whole, c); it; ++it)
        if (place[it.row()] >= 0 && place[it.col()] >= 0)
          entries.emplace_back(place[it.row()], place[it.col()], it.value());
    held_removed.resize(free, free);
    held_removed.setFromTriplets(entries.begin(), entries.end());
  }

  // K D - F, element by element, each without its rigid motion: the entries of a stiff sliver are so large
  // that they would lose in rounding what moving with its neighbours costs it, which is nothing.
  NodalColumns out_of_balance(const NodalColumns& d, const NodalColumns& f) const {
    NodalColumns rest = -f;
    for (std::size_t i = 0; i < structure.shells.size(); ++i)
      add_forces(structure.nodes_mm, structure.shells[i].nodes,
                 shell_stiffness(structure.shell(i), structure.material), d, &rest);
    for (std::size_t j = 0; j < structure.struts.size(); ++j)
      add_forces(structure.nodes_mm, structure.struts[j].nodes,
                 rigid_strut_stiffness(structure.strut(j), structure.material), d, &rest);
    return rest;
  }
};

StructureSolver::StructureSolver(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StructureSolver::~StructureSolver() = default;
StructureSolver::StructureSolver(StructureSolver&&) noexcept = default;

Result<StructureSolver> StructureSolver::factorise(const Structure& structure, const RunContext& context) {
  if (structure.nodes_mm.size() > kMaxStructureNodes)
    return invalid_input(fmt::format("{} nodes of the structure, more than {}", structure.nodes_mm.size(),
                                     kMaxStructureNodes));
  if (auto status = validate(structure); !status) return status.error();
  auto impl = std::make_unique<Impl>(structure);
  impl->number_freedoms();
  impl->remove_held(assemble(structure));
  if (context.cancelled()) return cancelled_error();
  if (impl->free > 0) {
    impl->factor.cholmod().print = 0;
    {
      const OrderingTurn turn;
      impl->factor.analyzePattern(impl->held_removed);
    }
    impl->factor.factorize(impl->held_removed);
    if (impl->factor.info() != Eigen::Success)
      return invalid_input("the structure is not held by its supports, or falls apart");
  }
  if (context.cancelled()) return cancelled_error();
  return StructureSolver(std::move(impl));
}

const Structure& StructureSolver::structure() const { return impl_->structure; }

NodalColumns StructureSolver::solve(const NodalColumns& loads_n) const {
  SKINFRAME_CHECK(loads_n.rows() == static_cast<Eigen::Index>(impl_->place.size()));
  NodalColumns right(impl_->free, loads_n.cols());
  for (Eigen::Index i = 0; i < loads_n.rows(); ++i)
    if (impl_->place[i] >= 0) right.row(impl_->place[i]) = loads_n.row(i);
  NodalColumns d = NodalColumns::Zero(loads_n.rows(), loads_n.cols());
  if (impl_->free == 0) return d;
  const NodalColumns solved = impl_->factor.solve(right);
  for (Eigen::Index i = 0; i < loads_n.rows(); ++i)
    if (impl_->place[i] >= 0) d.row(i) = solved.row(impl_->place[i]);
  return d;
}

void StructureSolver::refine(const NodalColumns& loads_n, NodalColumns* displacements) const {
  *displacements -= solve(impl_->out_of_balance(*displacements, loads_n));
}

NodalColumns StructureSolver::reactions_n(const NodalColumns& d, const NodalColumns& f) const {
  NodalColumns out = impl_->out_of_balance(d, f);
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    if (impl_->place[i] >= 0) out.row(i).setZero();
  return out;
}

double StructureSolver::residual(const NodalColumns& d, const NodalColumns& f) const {
  const NodalColumns rest = impl_->out_of_balance(d, f);
  double worst = 0;
  for (Eigen::Index i = 0; i < rest.rows(); ++i)
    if (impl_->place[i] >= 0) worst = std::max(worst, rest.row(i).cwiseAbs().maxCoeff());
  const double largest = f.cwiseAbs().maxCoeff();
  return largest > 0 ? worst / largest : worst;
}

Balance StructureSolver::balance(const NodalColumns& d, const NodalColumns& f) const {
  const NodalColumns total = f + reactions_n(d, f);
  const auto& nodes = impl_->structure.nodes_mm;
  Vector3d low = nodes.front(), high = low;
  for (const Vector3d& p : nodes) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vector3d middle = (low + high) / 2;
  const double extent = (high - low).norm();
  Balance worst;
  for (Eigen::Index c = 0; c < f.cols(); ++c) {
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    double size = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto at = 6 * static_cast<Eigen::Index>(i);
      const Vector3d push = total.col(c).segment<3>(at);
      force += push;
      moment += (nodes[i] - middle).cross(push) + total.col(c).segment<3>(at + 3);
      size += f.col(c).segment<3>(at).norm() + f.col(c).segment<3>(at + 3).norm() / extent;
    }
    if (!(size > 0)) continue;
    worst.force = std::max(worst.force, force.norm() / size);
    worst.moment = std::max(worst.moment, moment.norm() / (size * extent));
  }
  return worst;
}

int StructureSolver::free_count() const { return impl_->free; }
VectorXd StructureSolver::multiply_free(const VectorXd& x) const {
  return impl_->held_removed.selfadjointView<Eigen::Lower>() * x;
}
VectorXd StructureSolver::half_solve_free(const VectorXd& x) const {
  return impl_->factor.solve_part(CHOLMOD_L, impl_->factor.solve_part(CHOLMOD_P, x));
}
VectorXd StructureSolver::other_half_solve_free(const VectorXd& x) const {
  return impl_->factor.solve_part(CHOLMOD_Pt, impl_->factor.solve_part(CHOLMOD_Lt, x));
}
int StructureSolver::free_index(int node, int freedom) const { return impl_->place[6 * node + freedom]; }

}  // namespace skinframe
