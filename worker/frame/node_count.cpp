// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/node_count.h"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "worker/frame/vertex_graph.h"

namespace skinframe {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;

template <class Visit>
void for_each_vertex(std::size_t count, const Visit& visit) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024), [&](const auto& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v) visit(v);
  });
}

Vectors vertex_normals(const TriangleMesh& mesh) {
  Vectors normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const Eigen::Vector3d n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    for (int v : t) normals[v] += n;
  }
  for (auto& n : normals) n.normalize();
  return normals;
}

double mean_edge_squared(const TriangleMesh& mesh, const VertexGraph& graph) {
  double sum = 0.0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (int i = graph.first[v]; i < graph.first[v + 1]; ++i) {
      sum += (mesh.vertices[graph.neighbour[i]] - mesh.vertices[v]).squaredNorm();
    }
  }
  return sum / std::max<double>(1.0, static_cast<double>(graph.neighbour.size()));
}

// Averaging over the ring `rounds` times spreads by sqrt(rounds * mean square edge) about.
template <class T>
void diffuse(std::vector<T>& values, const VertexGraph& graph, const std::vector<double>& areas, int rounds) {
  std::vector<T> next(values.size());
  for (int round = 0; round < rounds; ++round) {
    for_each_vertex(values.size(), [&](std::size_t v) {
      T sum = areas[v] * values[v];
      double weight = areas[v];
      for (int i = graph.first[v]; i < graph.first[v + 1]; ++i) {
        const int w = graph.neighbour[i];
        sum += areas[w] * values[w];
        weight += areas[w];
      }
      next[v] = weight > 0.0 ? T(sum / weight) : values[v];
    });
    values.swap(next);
  }
}

// Largest absolute principal curvature at v, 1/mm: the symmetric map S of the tangent plane that takes the
// steps to the neighbours to the changes of the normal, by least squares.
double largest_curvature(int v, const TriangleMesh& mesh, const VertexGraph& graph, const Vectors& normals) {
  const Eigen::Vector3d n = normals[v], e1 = n.unitOrthogonal(), e2 = n.cross(e1);
  Eigen::Matrix3d lhs = Eigen::Matrix3d::Zero();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  for (int i = graph.first[v]; i < graph.first[v + 1]; ++i) {
    const int w = graph.neighbour[i];
    const Eigen::Vector3d step = mesh.vertices[w] - mesh.vertices[v], turn = normals[w] - n;
    const double x = step.dot(e1), y = step.dot(e2), p = turn.dot(e1), q = turn.dot(e2);
    lhs += (Eigen::Matrix3d() << x * x, x * y, 0, x * y, x * x + y * y, x * y, 0, x * y, y * y).finished();
    rhs += Eigen::Vector3d(x * p, y * p + x * q, y * q);
  }
  lhs.diagonal().array() += 1e-9 * lhs.trace() + 1e-300;
  const Eigen::Vector3d s = lhs.ldlt().solve(rhs);
  return 0.5 * std::abs(s[0] + s[2]) + std::hypot(0.5 * (s[0] - s[2]), s[1]);
}

// a(x) <= a(y) + kEdgeGrading |x - y| along the edges: shortest paths from all vertices at once.
void grade(std::vector<double>& length, const TriangleMesh& mesh, const VertexGraph& graph) {
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reached_from = [&](int v, int w) {
    return length[v] + kEdgeGrading * (mesh.vertices[w] - mesh.vertices[v]).norm();
  };
  for (int v = 0; v < static_cast<int>(length.size()); ++v)
    if (std::any_of(graph.neighbour.begin() + graph.first[v], graph.neighbour.begin() + graph.first[v + 1],
                    [&](int w) { return reached_from(v, w) < length[w]; }))
      queue.emplace(length[v], v);
  while (!queue.empty()) {
    const auto [a, v] = queue.top();
    queue.pop();
    if (a > length[v]) continue;
    for (int i = graph.first[v]; i < graph.first[v + 1]; ++i) {
      const int w = graph.neighbour[i];
      const double reached = reached_from(v, w);
      if (reached < length[w]) queue.emplace(length[w] = reached, w);
    }
  }
}

}  // namespace

double finger_edge_mm(const SkinPlate& plate, double h) {
  const double nu = plate.poisson_ratio;
  const double bending = plate.tensile_modulus_mpa * h * h * h / (12.0 * (1.0 - nu * nu));  // B, N mm
  return std::sqrt(12.0) *
         std::sqrt(16.0 * std::numbers::pi * bending * plate.displacement_limit_mm / plate.finger_force_n);
}

std::vector<double> edge_length_field(const TriangleMesh& mesh, double finger_edge, double h) {
  const VertexGraph graph = vertex_graph(mesh);
  const auto areas = vertex_areas(mesh);
  const double sigma = kSmoothingInThicknesses * h;
  const double rounds = sigma * sigma / std::max(mean_edge_squared(mesh, graph), 1e-12);
  const int smoothing = static_cast<int>(std::clamp(std::ceil(rounds), 1.0, 200.0));

  Vectors normals = vertex_normals(mesh);
  diffuse(normals, graph, areas, smoothing);
  for (auto& n : normals) n = n.norm() > 1e-9 ? n.normalized() : Eigen::Vector3d::UnitZ();

  const double shortest = std::min(kEdgeFloorInThicknesses * h, finger_edge);
  // Node density, not length, is what averages without changing the count.
  std::vector<double> density(mesh.vertices.size());
  for_each_vertex(density.size(), [&](std::size_t v) {
    const double curvature = largest_curvature(static_cast<int>(v), mesh, graph, normals);
    const double chord_edge = std::sqrt(8.0 * h / std::max(curvature, 1e-12));
    const double a = std::clamp(chord_edge, shortest, finger_edge);
    density[v] = 1.0 / (a * a);
  });
  diffuse(density, graph, areas, smoothing);
  std::vector<double> length(density.size());
  for (std::size_t v = 0; v < length.size(); ++v) length[v] = 1.0 / std::sqrt(density[v]);
  grade(length, mesh, graph);
  return length;
}

void weigh_by_stress(const TriangleMesh& mesh, const StressMap& stress, double finger_edge,
                     std::vector<double>& length) {
  const auto areas = vertex_areas(mesh);
  std::vector<double> logarithm(areas.size(), std::numeric_limits<double>::quiet_NaN());
  for_each_vertex(areas.size(), [&](std::size_t v) {
    const auto s = stress.von_mises_mpa_at(mesh.vertices[v]);
    if (s && *s > 0.0) logarithm[v] = std::log(*s);
  });
  double sum = 0.0, area = 0.0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    if (std::isnan(logarithm[v])) continue;
    sum += areas[v] * logarithm[v];
    area += areas[v];
  }
  if (!(area > 0.0)) return;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    if (std::isnan(logarithm[v])) continue;
    const double factor = std::clamp(std::exp(kStressExponent * (logarithm[v] - sum / area)),
                                     kLeastStressFactor, kMostStressFactor);
    length[v] = std::min(length[v] / std::sqrt(factor), finger_edge);
  }
  grade(length, mesh, vertex_graph(mesh));
}

double node_demand(const TriangleMesh& mesh, const std::vector<double>& length) {
  const auto areas = vertex_areas(mesh);
  double count = 0.0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    count += 2.0 * areas[v] / (std::sqrt(3.0) * length[v] * length[v]);
  }
  return count;
}

}  // namespace skinframe
