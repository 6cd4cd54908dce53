// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/solve_structure.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "worker/sparse/node_cholesky.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

std::vector<std::pair<int, int>> links_of(const Structure& s) {
  std::vector<std::pair<int, int>> links;
  links.reserve(3 * s.shells.size() + s.struts.size());
  for (const StructureShell& shell : s.shells)
    for (int k = 0; k < 3; ++k) links.emplace_back(shell.nodes[k], shell.nodes[(k + 1) % 3]);
  for (const StructureStrut& strut : s.struts) links.emplace_back(strut.nodes[0], strut.nodes[1]);
  return links;
}

// What is neither held nor joined to nothing.
std::vector<char> free_freedoms(const Structure& s) {
  std::vector<char> joined(s.nodes_mm.size(), 0), free;
  for (const auto& shell : s.shells)
    for (const int v : shell.nodes) joined[v] = 1;
  for (const auto& strut : s.struts)
    for (const int v : strut.nodes) joined[v] = 1;
  for (std::size_t v = 0; v < joined.size(); ++v)
    for (int k = 0; k < 6; ++k) free.push_back(joined[v] && !s.held[v][k]);
  return free;
}

NodeMatrix assemble(const Structure& s) {
  NodeMatrix k(6, free_freedoms(s), links_of(s));
  for (std::size_t i = 0; i < s.shells.size(); ++i)
    k.add(s.shells[i].nodes, shell_stiffness(s.shell(i), s.material));
  for (std::size_t j = 0; j < s.struts.size(); ++j)
    k.add(s.struts[j].nodes, rigid_strut_stiffness(s.strut(j), s.material));
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

}  // namespace

struct StructureSolver::Impl {
  explicit Impl(const Structure& s) : structure(s), stiffness(assemble(s)) {}

  const Structure& structure;
  NodeMatrix stiffness;  // on the free freedoms
  std::optional<NodeCholesky> factor;

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
  if (context.cancelled()) return cancelled_error();
  impl->factor = NodeCholesky::factorise(impl->stiffness);
  if (!impl->factor) return invalid_input("the structure is not held by its supports, or falls apart");
  if (context.cancelled()) return cancelled_error();
  return StructureSolver(std::move(impl));
}

const Structure& StructureSolver::structure() const { return impl_->structure; }

NodalColumns StructureSolver::solve(const NodalColumns& loads_n) const {
  const NodeMatrix& k = impl_->stiffness;
  SKINFRAME_CHECK(loads_n.rows() == 6 * static_cast<Eigen::Index>(impl_->structure.nodes_mm.size()));
  NodalColumns right(k.rows(), loads_n.cols());
  for (Eigen::Index i = 0; i < loads_n.rows(); ++i)
    if (const int row = k.row(i); row >= 0) right.row(row) = loads_n.row(i);
  const NodalColumns solved = impl_->factor->solve(std::move(right));
  NodalColumns d = NodalColumns::Zero(loads_n.rows(), loads_n.cols());
  for (Eigen::Index i = 0; i < loads_n.rows(); ++i)
    if (const int row = k.row(i); row >= 0) d.row(i) = solved.row(row);
  return d;
}

void StructureSolver::refine(const NodalColumns& loads_n, NodalColumns* displacements) const {
  *displacements -= solve(impl_->out_of_balance(*displacements, loads_n));
}

NodalColumns StructureSolver::reactions_n(const NodalColumns& d, const NodalColumns& f) const {
  NodalColumns out = impl_->out_of_balance(d, f);
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    if (impl_->stiffness.row(i) >= 0) out.row(i).setZero();
  return out;
}

double StructureSolver::residual(const NodalColumns& d, const NodalColumns& f) const {
  const NodalColumns rest = impl_->out_of_balance(d, f);
  double worst = 0;
  for (Eigen::Index i = 0; i < rest.rows(); ++i)
    if (impl_->stiffness.row(i) >= 0) worst = std::max(worst, rest.row(i).cwiseAbs().maxCoeff());
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

int StructureSolver::free_count() const { return impl_->stiffness.rows(); }
VectorXd StructureSolver::multiply_free(const VectorXd& x) const {
  return impl_->stiffness.lower().selfadjointView<Eigen::Lower>() * x;
}
VectorXd StructureSolver::half_solve_free(const VectorXd& x) const { return impl_->factor->half_solve(x); }
VectorXd StructureSolver::other_half_solve_free(const VectorXd& x) const {
  return impl_->factor->other_half_solve(x);
}
int StructureSolver::free_index(int node, int freedom) const {
  return impl_->stiffness.row(6 * node + freedom);
}

}  // namespace skinframe
