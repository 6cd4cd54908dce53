// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/thin_out.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace skinframe {
namespace {

constexpr int kRounds = 8;
constexpr double kLeastTurnCosine = 0.5;
constexpr double kLeastRoundness =
    0.1;  // 4 sqrt(3) area / sum of squared sides: 1 for an equilateral triangle

// x^T A x + 2 b x + c: the sum of squared distances of x to n planes.
struct Quadric {
  Eigen::Matrix3f a = Eigen::Matrix3f::Zero();
  Eigen::Vector3f b = Eigen::Vector3f::Zero();
  float c = 0.0f;
  float n = 0.0f;

  void operator+=(const Quadric& q) {
    a += q.a;
    b += q.b;
    c += q.c;
    n += q.n;
  }
};

Eigen::Vector3d normal_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b - a).cross(c - a);
}

class Thinning {
 public:
  Thinning(TriangleMesh& mesh)
      : mesh_(mesh), quadrics_(mesh.vertices.size()), alive_(mesh.triangles.size(), 1) {
    left_ = mesh.triangles.size();
    for (const auto& t : mesh_.triangles) add_plane(t);
  }

  void run(std::size_t triangles, double tolerance) {
    for (int round = 1; round <= kRounds && left_ > triangles; ++round) {
      const double share = static_cast<double>(round) / kRounds;
      link_triangles();
      collapse_round(tolerance * tolerance * share * share, triangles);
      drop_dead();
    }
    drop_unused_vertices();
  }

 private:
  // A vertex's quadric has the vertex itself as its origin, so that floats are enough.
  void add_plane(const std::array<int, 3>& t) {
    const Eigen::Vector3d n =
        normal_of(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]).stableNormalized();
    const Eigen::Vector3f m = n.cast<float>();
    for (int v : t) {
      quadrics_[v].a += m * m.transpose();  // the plane goes through the vertex itself: b = c = 0
      quadrics_[v].n += 1.0f;
    }
  }

  // The quadric of `v`, moved to the origin `o`.
  Quadric about(int v, const Eigen::Vector3d& o) const {
    const Eigen::Vector3f d = (o - mesh_.vertices[v]).cast<float>();
    Quadric q = quadrics_[v];
    q.c += d.dot(q.a * d) + 2.0f * q.b.dot(d);
    q.b += q.a * d;
    return q;
  }

  void link_triangles() {
    first_.assign(mesh_.vertices.size() + 1, 0);
    for (const auto& t : mesh_.triangles) {
      for (int v : t) ++first_[v + 1];
    }
    for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
    around_.resize(3 * mesh_.triangles.size());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      for (int v : mesh_.triangles[t]) around_[next[v]++] = t;
    }
    touched_.assign(mesh_.vertices.size(), 0);
  }

  void collapse_round(double most, std::size_t triangles) {
    for (std::size_t t = 0; t < mesh_.triangles.size() && left_ > triangles; ++t) {
      for (int k = 0; k < 3 && alive_[t]; ++k) {
        const int u = mesh_.triangles[t][k], v = mesh_.triangles[t][(k + 1) % 3];
        if (u < v && !touched_[u] && !touched_[v]) try_collapse(u, v, most);
      }
    }
  }

  template <class Visit>
  void for_each_triangle(int v, Visit visit) const {
    for (int i = first_[v]; i < first_[v + 1]; ++i) {
      if (alive_[around_[i]]) visit(around_[i]);
    }
  }

  void try_collapse(int u, int v, double most) {
    const Eigen::Vector3d middle = 0.5 * (mesh_.vertices[u] + mesh_.vertices[v]);
    Quadric q = about(u, middle);
    q += about(v, middle);
    if (q.c < 0.0f) q.c = 0.0f;
    most *= q.n;
    Eigen::Vector3f x = Eigen::Vector3f::Zero();
    if (q.c > most) {
      // The middle is too far off: the best place there is, held near the edge where that is not unique.
      Eigen::Matrix3f a = q.a;
      a.diagonal().array() += 1e-3f * a.trace();
      x = -a.ldlt().solve(q.b);
      const float length = static_cast<float>((mesh_.vertices[u] - mesh_.vertices[v]).norm());
      if (!(x.norm() <= length)) return;
      if (q.c + x.dot(q.a * x) + 2.0f * q.b.dot(x) > most) return;
    }
    const Eigen::Vector3d place = (middle + x.cast<double>()).cast<float>().cast<double>();
    if (!keeps_manifold(u, v) || !keeps_shape(u, v, place) || !keeps_shape(v, u, place)) return;

    // Triangles keep their numbers until the round ends: the lists about all others stay true, those about u
    // do not.
    touched_[u] = touched_[v] = 1;
    for_each_triangle(v, [&](int t) {
      auto& corners = mesh_.triangles[t];
      if (std::find(corners.begin(), corners.end(), u) != corners.end()) {
        alive_[t] = 0;
        --left_;
      } else {
        std::replace(corners.begin(), corners.end(), v, u);
      }
    });
    mesh_.vertices[u] = place;
    Quadric moved = q;
    moved.b += q.a * x;
    moved.c = std::max(0.0f, q.c + x.dot(q.a * x) + 2.0f * q.b.dot(x));
    quadrics_[u] = moved;
  }

  // Two vertices may become one when they share exactly two neighbours, and the surface is a disc about each.
  bool keeps_manifold(int u, int v) {
    neighbours(u, near_u_);
    neighbours(v, near_v_);
    int shared = 0;
    for (int w : near_u_) shared += std::binary_search(near_v_.begin(), near_v_.end(), w);
    const auto is_disc = [&](int w, const std::vector<int>& near) {
      std::size_t triangles = 0;
      for_each_triangle(w, [&](int) { ++triangles; });
      return near.size() == triangles;
    };
    return shared == 2 && is_disc(u, near_u_) && is_disc(v, near_v_) && near_u_.size() + near_v_.size() > 8;
  }

  void neighbours(int v, std::vector<int>& near) const {
    near.clear();
    for_each_triangle(v, [&](int t) {
      for (int w : mesh_.triangles[t]) {
        if (w != v) near.push_back(w);
      }
    });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }

  bool keeps_shape(int moved, int gone, const Eigen::Vector3d& place) const {
    bool good = true;
    for_each_triangle(moved, [&](int t) {
      const auto& corners = mesh_.triangles[t];
      if (!good || std::find(corners.begin(), corners.end(), gone) != corners.end()) return;
      std::array<Eigen::Vector3d, 3> p;
      for (int k = 0; k < 3; ++k) p[k] = mesh_.vertices[corners[k]];
      const Eigen::Vector3d before = normal_of(p[0], p[1], p[2]);
      for (int k = 0; k < 3; ++k) {
        if (corners[k] == moved) p[k] = place;
      }
      const Eigen::Vector3d after = normal_of(p[0], p[1], p[2]);
      const double sides =
          (p[1] - p[0]).squaredNorm() + (p[2] - p[1]).squaredNorm() + (p[0] - p[2]).squaredNorm();
      good = after.dot(before) >= kLeastTurnCosine * after.norm() * before.norm() &&
             2.0 * std::sqrt(3.0) * after.norm() >= kLeastRoundness * sides;
    });
    return good;
  }

  void drop_dead() {
    std::size_t used = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (alive_[t]) mesh_.triangles[used++] = mesh_.triangles[t];
    }
    mesh_.triangles.resize(used);
    alive_.assign(used, 1);
  }

  void drop_unused_vertices() {
    std::vector<int> place(mesh_.vertices.size(), -1);
    for (const auto& t : mesh_.triangles) {
      for (int v : t) place[v] = 0;
    }
    int used = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
      if (place[v] < 0) continue;
      place[v] = used;
      mesh_.vertices[used++] = mesh_.vertices[v];
    }
    mesh_.vertices.resize(used);
    for (auto& t : mesh_.triangles) {
      for (int& v : t) v = place[v];
    }
  }

  TriangleMesh& mesh_;
  std::vector<Quadric> quadrics_;
  std::vector<char> alive_;
  std::size_t left_ = 0;
  std::vector<int> first_, around_;
  std::vector<char> touched_;  // the two ends of each collapse of this round
  std::vector<int> near_u_, near_v_;
};

}  // namespace

void thin_out(TriangleMesh& mesh, std::size_t triangles, double tolerance_mm) {
  if (mesh.triangles.size() > triangles) Thinning(mesh).run(triangles, tolerance_mm);
}

}  // namespace skinframe
