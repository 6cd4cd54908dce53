// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/follow_skin.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <numbers>
#include <optional>
#include <set>

#include "worker/frame/flips.h"
#include "worker/frame/half_edge.h"
#include "worker/frame/on_m1.h"
#include "worker/frame/point_tree.h"

namespace skinframe {
namespace {

using Halfedge = HalfEdgeMesh::Halfedge_index;
using Vertex = HalfEdgeMesh::Vertex_index;
using Edge = HalfEdgeMesh::Edge_index;
using Edges = std::set<Edge>;

constexpr double kWorthAFlip = 0.8;          // of the deviation before
constexpr double kLeastFlippedAngle = 22.0;  // degrees, of the two triangles after such a flip
constexpr double kTurnCosine = 0.7;          // of the normal at a node that moves
constexpr double kOnM1InVoxels = 0.5;
constexpr double kLeastDividedAngle = 0.1;  // radians, at the nodes across from a new one
constexpr double kLeastShareOfEdge = 0.2;   // a new node's distance from both ends

class Following {
 public:
  Following(HalfEdgeMesh& mesh, const std::vector<char>& held, const std::vector<std::pair<int, int>>& kept,
            const Skin& skin)
      : mesh_(mesh), skin_(skin) {
    kept_ = mesh_.add_property_map<Edge, bool>("e:kept", false).first;
    for (const auto& [a, b] : kept)
      if (const Halfedge h = mesh_.halfedge(Vertex(a), Vertex(b)); h.is_valid()) kept_[mesh_.edge(h)] = true;
    held_ = mesh_.add_property_map<Vertex, bool>("v:held", false).first;
    for (std::size_t v = 0; v < held.size(); ++v) held_[Vertex(static_cast<int>(v))] = held[v] != 0;
    ratio_ = mesh_.add_property_map<Edge, double>("e:ratio", 0.0).first;
    stuck_ = mesh_.add_property_map<Edge, bool>("e:stuck", false).first;
    for (auto e : mesh_.edges()) measure(e);
    most_nodes_ =
        static_cast<std::size_t>((1.0 + kMostAdded) * static_cast<double>(mesh_.number_of_vertices()));
  }

  bool flip_deviating() {
    bool any = false;
    for (auto e : mesh_.edges()) {
      if (ratio_[e] <= 1.0) continue;
      const Halfedge h = mesh_.halfedge(e);
      if (kept_[e] || !may_flip(mesh_, h)) continue;
      const auto [c, d] = others(h);
      if (ratio_between(c, d) > kWorthAFlip * ratio_[e] || angle_after_flip(h) < kLeastFlippedAngle) continue;
      CGAL::Euler::flip_edge(h, mesh_);
      measure(e);
      ++done.edges_flipped;
      any = true;
    }
    return any;
  }

  // Divides the worst edge that can be; false when there is none.
  bool divide_worst() {
    if (mesh_.number_of_vertices() >= most_nodes_) return false;
    Edge worst;
    double ratio = 1.0;
    for (auto e : mesh_.edges()) {
      if (stuck_[e] || ratio_[e] <= ratio) continue;
      worst = e;
      ratio = ratio_[e];
    }
    if (!worst.is_valid()) return false;
    const Halfedge h = mesh_.halfedge(worst);
    const auto node = place_for(h);
    if (!node) {
      stuck_[worst] = true;
      return true;
    }
    const Halfedge to_node = CGAL::Euler::split_edge(h, mesh_);
    mesh_.point(mesh_.target(to_node)) = to_cgal(*node);
    const bool kept = kept_[worst];
    kept_[mesh_.edge(h)] = kept_[mesh_.edge(to_node)] = kept;
    held_[mesh_.target(to_node)] = kept;
    CGAL::Euler::split_face(to_node, mesh_.next(h), mesh_);
    CGAL::Euler::split_face(mesh_.opposite(h), mesh_.next(mesh_.opposite(to_node)), mesh_);
    ++done.nodes_added;
    legalise_about(mesh_.target(to_node));
    return true;
  }

  // Moves each node that is not held towards the middle of its neighbours, on M1, where that widens the least
  // angle about it and brings no deviation.
  void round_triangles() {
    for (auto v : mesh_.vertices()) {
      if (held_[v]) continue;
      const Eigen::Vector3d from = at(v);
      const double angle = least_angle_about(v), ratio = worst_ratio_about(v);
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (auto w : mesh_.vertices_around_target(mesh_.halfedge(v))) middle += at(w);
      middle /= static_cast<double>(mesh_.degree(v));
      const Eigen::Vector3d normal = normal_about(v);
      for (const double step : {1.0, 0.4}) {
        const Eigen::Vector3d off = step * (middle - from);
        const Eigen::Vector3d to = onto_m1(from + off - off.dot(normal) * normal, skin_);
        if (std::abs(skin_.field.at(to) + skin_.thickness_mm) > kOnM1InVoxels * skin_.voxel_mm) continue;
        mesh_.point(v) = to_cgal(to);
        if (least_angle_about(v) > angle && normal_about(v).dot(normal) > kTurnCosine &&
            !folds_about(v, normal) && worst_ratio_about(v) <= std::max(1.0, ratio))
          break;
        mesh_.point(v) = to_cgal(from);
      }
      for (auto h : CGAL::halfedges_around_target(v, mesh_)) measure(mesh_.edge(h));
    }
    flip_to_delaunay(mesh_, [&](Halfedge h) {
      const auto [c, d] = others(h);
      return !kept_[mesh_.edge(h)] && ratio_between(c, d) <= std::max(1.0, ratio_[mesh_.edge(h)]);
    });
    for (auto e : mesh_.edges()) measure(e);
  }

  std::vector<std::pair<int, int>> kept_edges() const {
    std::vector<std::pair<int, int>> kept;
    for (auto e : mesh_.edges())
      if (kept_[e])
        kept.emplace_back(static_cast<int>(mesh_.vertex(e, 0)), static_cast<int>(mesh_.vertex(e, 1)));
    return kept;
  }

  SkinFollowing done;
  int edges_left() const {
    int left = 0;
    for (auto e : mesh_.edges()) left += ratio_[e] > 1.0;
    return left;
  }

 private:
  Eigen::Vector3d at(Vertex v) const { return to_eigen(mesh_.point(v)); }
  std::pair<Vertex, Vertex> others(Halfedge h) const {
    return {mesh_.target(mesh_.next(h)), mesh_.target(mesh_.next(mesh_.opposite(h)))};
  }
  double ratio_at(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    const auto [outward, inward] = chord_deviation(a, b, skin_);
    return std::max(outward / kOutwardInThicknesses, inward / kInwardInThicknesses) / skin_.thickness_mm;
  }
  double ratio_between(Vertex a, Vertex b) const { return ratio_at(at(a), at(b)); }
  void measure(Edge e) {
    const Halfedge h = mesh_.halfedge(e);
    ratio_[e] = ratio_between(mesh_.source(h), mesh_.target(h));
    stuck_[e] = false;
  }

  double least_angle_about(Vertex v) const {
    double least = std::numbers::pi;
    for (auto h : CGAL::halfedges_around_target(v, mesh_)) {
      const Eigen::Vector3d p = at(v), q = at(mesh_.target(mesh_.next(h))), r = at(mesh_.source(h));
      least = std::min({least, angle_at(p, q, r), angle_at(q, r, p), angle_at(r, p, q)});
    }
    return least;
  }
  double worst_ratio_about(Vertex v) const {
    double worst = 0.0;
    for (auto w : mesh_.vertices_around_target(mesh_.halfedge(v)))
      worst = std::max(worst, ratio_between(v, w));
    return worst;
  }
  Eigen::Vector3d normal_about(Vertex v) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (auto h : CGAL::halfedges_around_target(v, mesh_)) sum += normal_of(h);
    return sum.normalized();
  }
  // Whether a triangle about v looks away from the normal that its surroundings had.
  bool folds_about(Vertex v, const Eigen::Vector3d& normal) const {
    for (auto h : CGAL::halfedges_around_target(v, mesh_))
      if (normal_of(h).dot(normal) <= 0.0) return true;
    return false;
  }
  Eigen::Vector3d normal_of(Halfedge h) const {
    const Eigen::Vector3d a = at(mesh_.source(h));
    return (at(mesh_.target(h)) - a).cross(at(mesh_.target(mesh_.next(h))) - a);
  }

  double angle_after_flip(Halfedge h) const {
    const Eigen::Vector3d a = at(mesh_.source(h)), b = at(mesh_.target(h));
    const auto [vc, vd] = others(h);
    const Eigen::Vector3d c = at(vc), d = at(vd);
    const double least = std::min({angle_at(a, c, d), angle_at(b, c, d), angle_at(c, a, d), angle_at(c, b, d),
                                   angle_at(d, a, c), angle_at(d, b, c)});
    return least * 180.0 / std::numbers::pi;
  }

  // Along the normal of the two triangles from the middle of the edge to M1; the field's nearest point of M1
  // where that finds none. None when the new node would fold the surface or crowd an end.
  std::optional<Eigen::Vector3d> place_for(Halfedge h) {
    const Eigen::Vector3d a = at(mesh_.source(h)), b = at(mesh_.target(h));
    const double length = (b - a).norm();
    if (length < kShortestDividedInThicknesses * skin_.thickness_mm) return std::nullopt;
    const auto [vc, vd] = others(h);
    const Eigen::Vector3d c = at(vc), d = at(vd);
    const Eigen::Vector3d left = (b - a).cross(c - a), right = (d - a).cross(b - a);
    const Eigen::Vector3d normal = (left.normalized() + right.normalized()).normalized();
    // How much is amiss: lengths of what deviates, by how far. It must become less.
    const auto amiss = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
      return std::max(0.0, ratio_at(p, q) - 1.0) * (q - p).norm();
    };
    const double before = amiss(a, b);
    const auto fits = [&](const Eigen::Vector3d& p) {
      if (!p.allFinite() || std::abs(skin_.field.at(p) + skin_.thickness_mm) > kOnM1InVoxels * skin_.voxel_mm)
        return false;
      if (std::min((p - a).norm(), (p - b).norm()) < kLeastShareOfEdge * length) return false;
      return (p - a).cross(c - a).dot(left) > 0.0 && (b - p).cross(c - p).dot(left) > 0.0 &&
             (d - a).cross(p - a).dot(right) > 0.0 && (d - p).cross(b - p).dot(right) > 0.0 &&
             std::min({angle_at(c, a, p), angle_at(c, p, b), angle_at(d, a, p), angle_at(d, p, b)}) >
                 kLeastDividedAngle &&
             amiss(a, p) + amiss(p, b) + amiss(p, c) + amiss(p, d) < before;
    };
    for (const double share : {0.5, 0.35, 0.65}) {
      const Eigen::Vector3d from = a + share * (b - a);
      if (const auto hit = first_on_m1(from, normal, 0.5 * length, skin_); hit && fits(*hit)) return hit;
      if (const Eigen::Vector3d near = onto_m1(from, skin_); fits(near)) return near;
      // Beyond the field's outer band only the sampled surface knows where M1 is.
      if (!surface_) surface_.emplace(skin_.inner_surface.vertices);
      if (const Eigen::Vector3d near = onto_m1(surface_->point(surface_->nearest(from)), skin_); fits(near))
        return near;
    }
    return std::nullopt;
  }

  // Measures what is new, and flips to Delaunay about the node where that brings no deviation.
  void legalise_about(Vertex node) {
    Edges todo;
    for (auto h : CGAL::halfedges_around_target(node, mesh_)) {
      measure(mesh_.edge(h));
      todo.insert(mesh_.edge(mesh_.prev(h)));
    }
    for (int guard = 0; !todo.empty() && guard < 64; ++guard) {
      const Edge e = *todo.begin();
      todo.erase(todo.begin());
      const Halfedge h = mesh_.halfedge(e);
      const auto [c, d] = others(h);
      const Eigen::Vector3d a = at(mesh_.source(h)), b = at(mesh_.target(h));
      if (angle_at(at(c), a, b) + angle_at(at(d), a, b) <= std::numbers::pi + 1e-3) continue;
      if (kept_[e] || !may_flip(mesh_, h) || ratio_between(c, d) > std::max(1.0, ratio_[e])) continue;
      for (const Halfedge side :
           {mesh_.next(h), mesh_.prev(h), mesh_.next(mesh_.opposite(h)), mesh_.prev(mesh_.opposite(h))})
        todo.insert(mesh_.edge(side));
      CGAL::Euler::flip_edge(h, mesh_);
      measure(e);
    }
  }

  HalfEdgeMesh& mesh_;
  const Skin& skin_;
  HalfEdgeMesh::Property_map<Edge, double> ratio_;
  HalfEdgeMesh::Property_map<Edge, bool> stuck_, kept_;
  HalfEdgeMesh::Property_map<Vertex, bool> held_;
  std::optional<PointTree> surface_;
  std::size_t most_nodes_ = 0;
};

constexpr int kFlipRounds = 3;
constexpr int kRoundingRounds = 6;

}  // namespace

Result<SkinFollowing> follow_skin(TriangleMesh& triangles, const std::vector<char>& held,
                                  std::vector<std::pair<int, int>>& kept, const Skin& skin,
                                  const RunContext& context) {
  try {
    HalfEdgeMesh mesh;
    for (const auto& p : triangles.vertices) mesh.add_vertex(to_cgal(p));
    for (const auto& t : triangles.triangles) {
      if (!mesh.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])).is_valid())
        return internal_error("the skin triangulation is not a manifold");
    }
    Following following(mesh, held, kept, skin);
    for (int round = 0; round < kFlipRounds && following.flip_deviating(); ++round) {
    }
    while (following.divide_worst()) {
      if (context.cancelled()) return cancelled_error();
    }
    for (int round = 0; round < kRoundingRounds; ++round) {
      if (context.cancelled()) return cancelled_error();
      following.round_triangles();
    }
    following.done.edges_left = following.edges_left();
    kept = following.kept_edges();
    triangles = {};
    for (auto v : mesh.vertices()) triangles.vertices.push_back(to_eigen(mesh.point(v)));
    for (auto f : mesh.faces()) {
      const auto h = mesh.halfedge(f);
      triangles.triangles.push_back({static_cast<int>(mesh.source(h)), static_cast<int>(mesh.target(h)),
                                     static_cast<int>(mesh.target(mesh.next(h)))});
    }
    return following.done;
  } catch (const std::bad_alloc&) {
    throw;  // the job ends OUT_OF_MEMORY, not INTERNAL
  } catch (const std::exception& e) {
    return internal_error(std::string("the skin struts could not be made to follow the skin: ") + e.what());
  }
}

}  // namespace skinframe
