// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/sharp_edges.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace skinframe {
namespace {

constexpr double kOffM1InVoxels = 1.0;  // of the fine grid; M1's edges stand on a ridge of the field
constexpr double kSameFaceCosine = 0.996;
constexpr double kLeastSpread = 0.2;  // singular value below which faces count as one

double cosine(double degrees) { return std::cos(degrees * std::numbers::pi / 180.0); }

struct Edges {
  std::vector<std::pair<int, int>> sharp;   // in order of their vertices
  std::vector<std::vector<int>> at_corner;  // numbers of sharp edges, by vertex; empty lists for most
  std::vector<std::vector<Eigen::Vector3d>> normals;  // of the faces about a vertex of a sharp edge
};

struct Side {
  int low, high;  // vertices
  int triangle;   // whose side leads from low to high, or -1 - the one whose side leads back
};

std::vector<Side> sides_of(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) {
    const auto& t = mesh.triangles[i];
    for (int k = 0; k < 3; ++k) {
      const int u = t[k], v = t[(k + 1) % 3];
      sides.push_back(u < v ? Side{u, v, i} : Side{v, u, -1 - i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

Edges sharp_edges_of(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normal(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    normal[i] = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
  }
  Edges edges;
  edges.at_corner.resize(mesh.vertices.size());
  edges.normals.resize(mesh.vertices.size());
  const double sharp = cosine(kSharpAngleDegrees);
  const auto sides = sides_of(mesh);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &back = sides[i], &forth = sides[i + 1];
    if (back.low != forth.low || back.high != forth.high || back.triangle >= 0 || forth.triangle < 0)
      continue;
    const Eigen::Vector3d &n = normal[forth.triangle], &m = normal[-1 - back.triangle];
    const bool outwards = n.cross(m).dot(mesh.vertices[forth.high] - mesh.vertices[forth.low]) > 0.0;
    if (!outwards || n.dot(m) > sharp) continue;
    const int number = static_cast<int>(edges.sharp.size());
    edges.sharp.emplace_back(forth.low, forth.high);
    edges.at_corner[forth.low].push_back(number);
    edges.at_corner[forth.high].push_back(number);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const int v : mesh.triangles[i]) {
      auto& known = edges.normals[v];
      if (edges.at_corner[v].empty() || !normal[i].allFinite()) continue;
      if (std::none_of(known.begin(), known.end(),
                       [&](const Eigen::Vector3d& n) { return n.dot(normal[i]) > kSameFaceCosine; }))
        known.push_back(normal[i]);
    }
  return edges;
}

// The point h below all of those faces about q, the nearest to q where they leave a choice.
Eigen::Vector3d below(const Eigen::Vector3d& q, const std::vector<Eigen::Vector3d>& normals, double h) {
  Eigen::MatrixXd rows(normals.size(), 3);
  for (std::size_t i = 0; i < normals.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = normals[i];
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(kLeastSpread / std::max(svd.singularValues()[0], kLeastSpread));
  return q - h * Eigen::Vector3d(svd.solve(Eigen::VectorXd::Ones(rows.rows())));
}

class Tracing {
 public:
  Tracing(const TriangleMesh& mesh, const DistanceField& field, double thickness)
      : mesh_(mesh), field_(field), thickness_(thickness), edges_(sharp_edges_of(mesh)) {
    used_.assign(edges_.sharp.size(), 0);
  }

  std::vector<SharpCurve> curves() {
    std::vector<SharpCurve> found;
    // From ends, forks and bends first; what is left are loops.
    for (const bool loops : {false, true})
      for (int e = 0; e < static_cast<int>(edges_.sharp.size()); ++e)
        for (const int start : {edges_.sharp[e].first, edges_.sharp[e].second})
          if (!used_[e] && (loops || !passes(start))) add_valid_runs(trace(start, e), found);
    return found;
  }

 private:
  int across(int edge, int vertex) const {
    const auto& [u, v] = edges_.sharp[edge];
    return u == vertex ? v : u;
  }
  // Whether a curve goes on through the vertex.
  bool passes(int vertex) const {
    const auto& at = edges_.at_corner[vertex];
    if (at.size() != 2) return false;
    const Eigen::Vector3d& p = mesh_.vertices[vertex];
    const Eigen::Vector3d in = (p - mesh_.vertices[across(at[0], vertex)]).normalized(),
                          out = (mesh_.vertices[across(at[1], vertex)] - p).normalized();
    return in.dot(out) >= cosine(kSharpBendDegrees);
  }
  std::vector<int> trace(int vertex, int edge) {
    std::vector<int> path{vertex};
    const int start = vertex;
    while (true) {
      used_[edge] = 1;
      vertex = across(edge, vertex);
      path.push_back(vertex);
      if (vertex == start || !passes(vertex)) return path;
      const auto& at = edges_.at_corner[vertex];
      edge = at[0] == edge ? at[1] : at[0];
      if (used_[edge]) return path;
    }
  }
  bool on_m1(const Eigen::Vector3d& p) const {
    return std::abs(field_.at(p) + thickness_) <= kOffM1InVoxels * field_.voxel_mm();
  }

  // The path's offset, cut where it is not on M1.
  void add_valid_runs(const std::vector<int>& path, std::vector<SharpCurve>& found) const {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Eigen::Vector3d to = below(mesh_.vertices[path[i]], edges_.normals[path[i]], thickness_);
      if (i > 0) {
        const Eigen::Vector3d from = points.back();
        const int steps =
            std::max(1, static_cast<int>(std::ceil((to - from).norm() / field_.coarse_voxel_mm())));
        for (int k = 1; k < steps; ++k)
          points.push_back(from + (to - from) * (static_cast<double>(k) / steps));
      }
      points.push_back(to);
    }
    const bool closed = path.size() > 3 && path.front() == path.back();
    SharpCurve run;
    const auto end_run = [&] {
      run.closed = closed && run.points_mm.size() == points.size();
      if (run.points_mm.size() > 1 && run.length_mm() >= kLeastCurveInThicknesses * thickness_)
        found.push_back(std::move(run));
      run = {};
    };
    for (const Eigen::Vector3d& p : points) {
      if (on_m1(p)) {
        run.points_mm.push_back(p);
      } else {
        end_run();
      }
    }
    end_run();
  }

  const TriangleMesh& mesh_;
  const DistanceField& field_;
  double thickness_;
  Edges edges_;
  std::vector<char> used_;
};

}  // namespace

double SharpCurve::length_mm() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < points_mm.size(); ++i) sum += (points_mm[i] - points_mm[i - 1]).norm();
  return sum;
}

std::vector<SharpCurve> find_sharp_edges(const TriangleMesh& mesh, const DistanceField& field,
                                         double thickness) {
  return Tracing(mesh, field, thickness).curves();
}

}  // namespace skinframe
