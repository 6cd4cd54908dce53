// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/quadratic_solid.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "worker/stress/isotropic.h"
#include "worker/stress/solve_held.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Strain = Eigen::Matrix<double, 6, 30>;

constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

// Corners as in the tetrahedra, then a node in the middle of each edge.
struct QuadraticMesh {
  std::vector<Vector3d> nodes_mm;
  std::vector<std::array<int, 10>> tets;
  std::vector<std::array<int, 6>> surface;  // corners, then the middles of sides 01, 12, 20
};

QuadraticMesh with_middles(const TetMesh& linear) {
  const TetMesh mesh = largest_component(linear);
  QuadraticMesh out;
  std::vector<int> renamed(mesh.vertices_mm.size(), -1);
  const auto corner = [&](int v) {
    if (renamed[v] < 0) {
      renamed[v] = static_cast<int>(out.nodes_mm.size());
      out.nodes_mm.push_back(mesh.vertices_mm[v]);
    }
    return renamed[v];
  };
  std::map<std::pair<int, int>, int> known;
  const auto middle = [&](int a, int b) {
    const auto [it, fresh] = known.try_emplace(std::minmax(a, b), static_cast<int>(out.nodes_mm.size()));
    if (fresh) out.nodes_mm.push_back((out.nodes_mm[a] + out.nodes_mm[b]) / 2);
    return it->second;
  };
  for (const auto& tet : mesh.tets) {
    std::array<int, 10> e{};
    for (int i = 0; i < 4; ++i) e[i] = corner(tet[i]);
    for (int k = 0; k < 6; ++k) e[4 + k] = middle(e[kEdges[k][0]], e[kEdges[k][1]]);
    out.tets.push_back(e);
  }
  for (const auto& face : boundary_of(mesh)) {
    const int a = corner(face[0]), b = corner(face[1]), c = corner(face[2]);
    out.surface.push_back({a, b, c, middle(a, b), middle(b, c), middle(c, a)});
  }
  return out;
}

// Gradients of the area coordinates, one a column, and the volume.
std::pair<Eigen::Matrix<double, 3, 4>, double> slopes_of(const QuadraticMesh& mesh,
                                                         const std::array<int, 10>& e) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.row(k) = (mesh.nodes_mm[e[k + 1]] - mesh.nodes_mm[e[0]]).transpose();
  Eigen::Matrix<double, 3, 4> slopes;
  slopes.rightCols<3>() = edges.inverse();
  slopes.col(0) = -slopes.rightCols<3>().rowwise().sum();
  return {slopes, edges.determinant() / 6};
}

Strain strain_at(const Eigen::Matrix<double, 3, 4>& slopes, const std::array<double, 4>& l) {
  Strain b = Strain::Zero();
  for (int i = 0; i < 10; ++i) {
    Vector3d g;
    if (i < 4) {
      g = (4 * l[i] - 1) * slopes.col(i);
    } else {
      const auto& [p, q] = kEdges[i - 4];
      g = 4 * (l[p] * slopes.col(q) + l[q] * slopes.col(p));
    }
    const double x = g[0], y = g[1], z = g[2];
    b.block<6, 3>(0, 3 * i) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
  }
  return b;
}

Eigen::Matrix<double, 30, 30> element_stiffness(const QuadraticMesh& mesh, const std::array<int, 10>& e,
                                                const Eigen::Matrix<double, 6, 6>& d) {
  constexpr double kNear = 0.58541019662496852, kFar = 0.13819660112501051;
  const auto [slopes, volume] = slopes_of(mesh, e);
  Eigen::Matrix<double, 30, 30> k = Eigen::Matrix<double, 30, 30>::Zero();
  for (int point = 0; point < 4; ++point) {
    std::array<double, 4> l{kFar, kFar, kFar, kFar};
    l[point] = kNear;
    const Strain b = strain_at(slopes, l);
    const Strain stress = d * b;
    k.noalias() += volume / 4 * b.transpose() * stress;
  }
  return k;
}

NodeMatrix stiffness_of(const QuadraticMesh& mesh, const std::vector<char>& is_free,
                        const Eigen::Matrix<double, 6, 6>& d) {
  std::vector<std::pair<int, int>> links;
  links.reserve(mesh.tets.size() * 45);
  for (const auto& e : mesh.tets)
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j < i; ++j) links.emplace_back(e[i], e[j]);
  NodeMatrix k(3, is_free, std::move(links));
  for (const auto& e : mesh.tets) k.add(e, element_stiffness(mesh, e, d));
  return k;
}

// Constant over triangles whose middle is within the radius of the surface's nearest node: a third of it on
// the middle of each side.
void press(const QuadraticMesh& mesh, const StressLoad& load, Eigen::Ref<Eigen::VectorXd> f) {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.surface)
    for (const int v : t) {
      const double d = (mesh.nodes_mm[v] - load.point_mm).squaredNorm();
      if (d < least) {
        least = d;
        nearest = v;
      }
    }
  std::vector<std::pair<const std::array<int, 6>*, double>> patch;
  double area = 0;
  for (const auto& t : mesh.surface) {
    const Vector3d &a = mesh.nodes_mm[t[0]], &b = mesh.nodes_mm[t[1]], &c = mesh.nodes_mm[t[2]];
    if (((a + b + c) / 3 - mesh.nodes_mm[nearest]).norm() > load.radius_mm) continue;
    patch.emplace_back(&t, (b - a).cross(c - a).norm());
    area += patch.back().second;
  }
  if (!(area > 0)) {
    f.segment<3>(3 * nearest) += load.force_n;
    return;
  }
  for (const auto& [t, share] : patch)
    for (int k = 3; k < 6; ++k) f.segment<3>(3 * (*t)[k]) += load.force_n * (share / (3 * area));
}

Eigen::VectorXd weight_n(const QuadraticMesh& mesh, double density) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes_mm.size()));
  for (const auto& e : mesh.tets) {
    const double weight = density * slopes_of(mesh, e).second;
    for (int i = 0; i < 10; ++i) f[3 * e[i] + 2] -= i < 4 ? -weight / 20 : weight / 5;
  }
  return f;
}

std::vector<char> free_axes(const QuadraticMesh& mesh, const std::function<bool(const Vector3d&)>& held) {
  std::vector<char> is_free(3 * mesh.nodes_mm.size(), 1);
  for (const auto& t : mesh.surface)
    for (const int v : t)
      if (held(mesh.nodes_mm[v])) std::fill_n(is_free.begin() + 3 * v, 3, 0);
  return is_free;
}

// Of each node its first row, -1 where it is held; and how many rows there are.
std::pair<std::vector<int>, int> rows_of(const std::vector<char>& is_free) {
  std::vector<int> first;
  int rows = 0;
  for (std::size_t i = 0; i < is_free.size(); i += 3) {
    first.push_back(is_free[i] ? rows : -1);
    if (is_free[i]) rows += 3;
  }
  return {std::move(first), rows};
}

Eigen::VectorXd pressed_n(const QuadraticMesh& mesh, const SolidCase& solid_case) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes_mm.size()));
  for (const StressLoad& load : solid_case.loads) press(mesh, load, f);
  return f;
}

Eigen::MatrixXd right_sides(const QuadraticMesh& mesh, const std::vector<int>& first_row, int rows,
                            const std::vector<SolidCase>& cases, double weight_density_n_mm3) {
  const Eigen::VectorXd weight = weight_n(mesh, weight_density_n_mm3);
  Eigen::MatrixXd right(rows, static_cast<Eigen::Index>(cases.size()));
  for (std::size_t c = 0; c < cases.size(); ++c) {
    Eigen::VectorXd f = pressed_n(mesh, cases[c]);
    if (cases[c].gravity) f += weight;
    for (std::size_t v = 0; v < first_row.size(); ++v)
      if (first_row[v] >= 0)
        right.block<3, 1>(first_row[v], static_cast<Eigen::Index>(c)) =
            f.segment<3>(3 * static_cast<Eigen::Index>(v));
  }
  return right;
}

SolidAnswer answer_of(const QuadraticMesh& mesh, const std::vector<int>& first_row,
                      const Eigen::Ref<const Eigen::VectorXd>& solution, const Eigen::VectorXd& external_n) {
  SolidAnswer answer;
  for (std::size_t v = 0; v < first_row.size(); ++v) {
    if (first_row[v] < 0) continue;
    const Vector3d u = solution.segment<3>(first_row[v]);
    answer.external_work_n_mm += u.dot(external_n.segment<3>(3 * static_cast<Eigen::Index>(v)));
    if (u.norm() <= answer.max_displacement_mm) continue;
    answer.max_displacement_mm = u.norm();
    answer.at_mm = mesh.nodes_mm[v];
  }
  return answer;
}

}  // namespace

Result<std::vector<SolidAnswer>> solve_quadratic_solid(const TetMesh& linear, const ElasticMaterial& material,
                                                       double weight_density_n_mm3,
                                                       const std::function<bool(const Vector3d&)>& held,
                                                       const std::vector<SolidCase>& cases,
                                                       const RunContext& context) {
  if (linear.tets.empty()) return invalid_input("no tetrahedra");
  if (linear.tets.size() > kMaxQuadraticTets)
    return invalid_input(fmt::format("{} tetrahedra, more than {}", linear.tets.size(), kMaxQuadraticTets));
  const QuadraticMesh mesh = with_middles(linear);
  const std::vector<char> is_free = free_axes(mesh, held);
  const auto numbered = rows_of(is_free);
  const auto& first_row = numbered.first;
  const int rows = numbered.second;
  if (rows == 0) return invalid_input("the solid is not held by its supports");
  const auto solution = solve_held(
      stiffness_of(mesh, is_free, isotropic_stiffness(material)),
      [&] { return right_sides(mesh, first_row, rows, cases, weight_density_n_mm3); }, context);
  if (!solution) return solution.error();
  std::vector<SolidAnswer> answers;
  for (std::size_t c = 0; c < cases.size(); ++c)  // pressed once more, rather than kept beside the factor
    answers.push_back(
        answer_of(mesh, first_row, solution->col(static_cast<Eigen::Index>(c)), pressed_n(mesh, cases[c])));
  return answers;
}

}  // namespace skinframe
