// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/triangulate_piece.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <new>
#include <optional>

#include "worker/frame/cvt_energy.h"
#include "worker/frame/flips.h"
#include "worker/frame/half_edge.h"
#include "worker/frame/point_tree.h"

namespace skinframe {
namespace {

using Vertex = HalfEdgeMesh::Vertex_index;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<HalfEdgeMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr int kEvenRounds = 10;     // first even,
constexpr int kRimRounds = 10;      // then on the rim,
constexpr int kCvtIterations = 50;  // then to the density
constexpr int kRoundingRounds = 2;  // and towards round triangles
constexpr int kFlipSweepsAfterCvt = 8;
constexpr double kOnRimMm = 1e-6;         // absolute: rounding
constexpr double kOntoRim = 0.35;         // in wanted edges: any node this near to the rim goes onto it
constexpr double kCrowdsNeighbour = 0.3;  // in wanted edges
constexpr double kCrowdsPin = 0.6;        // in wanted edges
constexpr double kContactOntoRim = 0.6;   // the contact's outermost nodes come from further

// The rim of the base contact: where edges of M1 cross its height.
std::vector<Eigen::Vector3d> rim_points(const HalfEdgeMesh& mesh, double contact_z) {
  std::vector<Eigen::Vector3d> rim;
  for (auto e : mesh.edges()) {
    const Eigen::Vector3d a = to_eigen(mesh.point(mesh.vertex(e, 0))),
                          b = to_eigen(mesh.point(mesh.vertex(e, 1)));
    if ((a.z() <= contact_z) == (b.z() <= contact_z)) continue;
    rim.push_back(a + (contact_z - a.z()) / (b.z() - a.z()) * (b - a));
  }
  return rim;
}

// The weighted centroid of the triangles about v, moved back into the tangent plane.
Eigen::Vector3d lloyd_step(const HalfEdgeMesh& mesh, const NodeTraitsMap& traits, Vertex v) {
  const Eigen::Vector3d p = to_eigen(mesh.point(v));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (auto h : CGAL::halfedges_around_target(v, mesh)) {
    const Vertex vb = mesh.target(mesh.next(h)), vc = mesh.source(h);
    const Eigen::Vector3d b = to_eigen(mesh.point(vb)), c = to_eigen(mesh.point(vc));
    const Eigen::Vector3d cross = (b - p).cross(c - p);
    const double a = (traits[v].edge_length_mm + traits[vb].edge_length_mm + traits[vc].edge_length_mm) / 3.0;
    const double w = 0.5 * cross.norm() / (a * a * a * a);
    sum += w * (p + b + c) / 3.0;
    weight += w;
    normal += cross;
  }
  if (!(weight > 0.0) || !(normal.norm() > 0.0)) return p;
  normal.normalize();
  const Eigen::Vector3d step = sum / weight - p;
  return p + step - step.dot(normal) * normal;
}

class Relaxation {
 public:
  Relaxation(const HalfEdgeMesh& surface, const std::vector<double>& edge_length, double contact_z,
             SharpChains& chains)
      : surface_(surface),
        chains_(chains),
        edge_length_(edge_length),
        contact_z_(contact_z),
        rim_(rim_points(surface, contact_z)) {
    tree_.insert(faces(surface).begin(), faces(surface).end(), surface);
    tree_.build();
    tree_.accelerate_distance_queries();
    samples_.weights.assign(surface.number_of_vertices(), 0.0);
    for (auto v : surface.vertices()) samples_.points.push_back(to_eigen(surface.point(v)));
    for (auto f : surface.faces()) {
      const auto h = surface.halfedge(f);
      const Vertex corners[3] = {surface.source(h), surface.target(h), surface.target(surface.next(h))};
      const Eigen::Vector3d& a = samples_.points[corners[0]];
      const double area =
          0.5 * (samples_.points[corners[1]] - a).cross(samples_.points[corners[2]] - a).norm();
      for (const Vertex v : corners) samples_.weights[v] += area / (3.0 * std::pow(edge_length[v], 4));
    }
  }

  // What stands for the rim where it is near.
  void set_pins(std::vector<Eigen::Vector3d> pins) { pins_ = PointTree(std::move(pins)); }

  void round(HalfEdgeMesh& mesh, NodeTraitsMap traits, bool onto_rim) const {
    flip(mesh, traits);
    std::vector<Eigen::Vector3d> moved(mesh.num_vertices());
    for (auto v : mesh.vertices()) moved[v] = lloyd_step(mesh, traits, v);
    for (auto v : mesh.vertices()) {
      if (traits[v].pinned || chains_.is_corner(traits[v].chain_vertex)) continue;
      if (traits[v].chain_vertex < 0) {
        project(mesh, traits, v, moved[v]);
      } else {
        mesh.point(v) = to_cgal(chains_.slide(traits[v].chain_vertex));
      }
    }
    if (!onto_rim || rim_.empty()) return;
    for (auto v : mesh.vertices()) {
      if (!is_kept(traits[v])) snap(mesh, traits, v);
    }
  }
  void flip(HalfEdgeMesh& mesh, NodeTraitsMap traits) const {
    flip_to_delaunay(mesh, [&](HalfEdgeMesh::Halfedge_index h) {
      return !chains_.are_joined(traits[mesh.source(h)].chain_vertex, traits[mesh.target(h)].chain_vertex);
    });
  }

  // By L-BFGS on the energy of the tessellation; pinned nodes and those on the rim or a sharp edge stay.
  void follow_density(HalfEdgeMesh& mesh, NodeTraitsMap traits, const RunContext& context) const {
    std::vector<Eigen::Vector3d> sites;
    std::vector<char> held;
    for (auto v : mesh.vertices()) {
      sites.push_back(to_eigen(mesh.point(v)));
      held.push_back(is_kept(traits[v]) || on_rim(sites.back()));
    }
    minimise_cvt(samples_, held, kCvtIterations, context, sites);
    for (auto v : mesh.vertices())
      if (!held[v]) project(mesh, traits, v, sites[v]);
    for (int sweep = 0; sweep < kFlipSweepsAfterCvt; ++sweep) flip(mesh, traits);
  }

 private:
  static bool is_kept(const NodeTraits& node) { return node.pinned || node.chain_vertex >= 0; }
  bool on_rim(const Eigen::Vector3d& p) const {
    return !rim_.empty() && (rim_.point(rim_.nearest(p)) - p).norm() < kOnRimMm;
  }

  void project(HalfEdgeMesh& mesh, NodeTraitsMap traits, Vertex v, const Eigen::Vector3d& p) const {
    const auto [point, face] = tree_.closest_point_and_primitive(to_cgal(p));
    mesh.point(v) = point;
    double sum = 0.0;
    for (auto w : surface_.vertices_around_face(surface_.halfedge(face))) sum += edge_length_[w];
    traits[v].edge_length_mm = sum / 3.0;
  }

  void snap(HalfEdgeMesh& mesh, NodeTraitsMap traits, Vertex v) const {
    const Eigen::Vector3d p = to_eigen(mesh.point(v)), q = rim_.point(rim_.nearest(p));
    const double distance = (q - p).norm() / traits[v].edge_length_mm;
    if (distance > kContactOntoRim) return;
    // A pin stands for the rim about it: another node there would only crowd.
    const double crowd = kCrowdsPin * traits[v].edge_length_mm;
    if (!pins_.empty() && (pins_.point(pins_.nearest(q)) - q).norm() < crowd) return;
    const auto in_contact = [&](Vertex w) { return mesh.point(w).z() <= contact_z_ + 1e-6; };
    bool outermost = in_contact(v);
    if (outermost) {
      outermost = false;
      for (auto w : mesh.vertices_around_target(mesh.halfedge(v))) outermost = outermost || !in_contact(w);
    }
    // Two nodes on either side of the rim may have the same nearest point of it; only one may stand there.
    for (auto w : mesh.vertices_around_target(mesh.halfedge(v)))
      if ((to_eigen(mesh.point(w)) - q).norm() < kCrowdsNeighbour * traits[v].edge_length_mm) return;
    if (distance <= kOntoRim || outermost) mesh.point(v) = to_cgal(q);
  }

  const HalfEdgeMesh& surface_;
  SharpChains& chains_;
  const std::vector<double>& edge_length_;
  double contact_z_;
  PointTree rim_, pins_{std::vector<Eigen::Vector3d>{}};
  WeightedSamples samples_;
  Tree tree_;
};

// Vertices that several umbrellas share become several; `origin` says which vertex of the piece each was.
Result<HalfEdgeMesh> to_half_edges(const TriangleMesh& piece, std::vector<int>& origin) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  struct Recorder : pmp::Default_orientation_visitor {
    explicit Recorder(std::vector<int>* list) : origins(list) {}
    void duplicated_vertex(std::size_t first, std::size_t copy) {
      if (origins->size() <= copy) origins->resize(copy + 1, 0);
      (*origins)[copy] = (*origins)[first];
    }
    std::vector<int>* origins;
  };
  std::vector<Kernel::Point_3> points;
  origin.resize(piece.vertices.size());
  for (std::size_t i = 0; i < piece.vertices.size(); ++i) {
    points.push_back(to_cgal(piece.vertices[i]));
    origin[i] = static_cast<int>(i);
  }
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const auto& t : piece.triangles) {
    triangles.push_back(
        {static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2])});
  }
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) {
    pmp::orient_polygon_soup(points, triangles, CGAL::parameters::visitor(Recorder(&origin)));
    if (!pmp::is_polygon_soup_a_polygon_mesh(triangles))
      return internal_error("a piece of M1 is not a manifold");
  }
  HalfEdgeMesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  if (!CGAL::is_closed(mesh) || mesh.number_of_vertices() != origin.size()) {
    return internal_error("a piece of M1 is not closed");
  }
  return mesh;
}

TriangleMesh to_triangles(const HalfEdgeMesh& mesh) {
  TriangleMesh result;
  for (auto v : mesh.vertices()) result.vertices.push_back(to_eigen(mesh.point(v)));
  for (auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    result.triangles.push_back({static_cast<int>(mesh.source(h)), static_cast<int>(mesh.target(h)),
                                static_cast<int>(mesh.target(mesh.next(h)))});
  }
  return result;
}

}  // namespace

Result<PieceTriangulation> triangulate_piece(const TriangleMesh& piece, const PieceSampling& sampling,
                                             const RunContext& context) {
  try {
    std::vector<int> origin;
    auto surface = to_half_edges(piece, origin);
    if (!surface) return surface.error();
    std::vector<double> edge_length(origin.size());
    for (std::size_t i = 0; i < origin.size(); ++i) edge_length[i] = sampling.edge_length_mm[origin[i]];

    HalfEdgeMesh mesh = *surface;
    NodeTraitsMap traits = mesh.add_property_map<Vertex, NodeTraits>("v:traits").first;
    for (auto v : mesh.vertices()) traits[v].edge_length_mm = edge_length[v];
    for (int pin : sampling.pins) traits[Vertex(pin)].pinned = true;
    SharpChains chains = sampling.chains;
    if (!chains.empty())
      for (std::size_t v = 0; v < piece.vertices.size(); ++v)
        if (chains.is_on(static_cast<int>(v)))
          traits[Vertex(static_cast<int>(v))].chain_vertex = static_cast<int>(v);
    std::optional<Relaxation> made;
    tbb::parallel_invoke([&] { collapse_to_count(mesh, traits, chains, sampling.nodes); },
                         [&] { made.emplace(*surface, edge_length, sampling.contact_z_mm, chains); });
    Relaxation& relaxation = *made;
    std::vector<Eigen::Vector3d> pins = chains.points_mm();  // what is left of the sharp edges
    for (int pin : sampling.pins) pins.push_back(piece.vertices[pin]);
    relaxation.set_pins(std::move(pins));
    for (int round = 0; round < kEvenRounds + kRimRounds; ++round) {
      if (context.cancelled()) return cancelled_error();
      relaxation.round(mesh, traits, round >= kEvenRounds);
    }
    relaxation.follow_density(mesh, traits, context);
    if (context.cancelled()) return cancelled_error();
    for (int round = 0; round < kRoundingRounds; ++round) relaxation.round(mesh, traits, true);
    relaxation.flip(mesh, traits);
    PieceTriangulation result{to_triangles(mesh), std::vector<char>(mesh.num_vertices(), 0), {}};
    for (auto v : mesh.vertices()) result.on_sharp_edge[v] = traits[v].chain_vertex >= 0;
    for (auto e : mesh.edges()) {
      const Vertex u = mesh.vertex(e, 0), v = mesh.vertex(e, 1);
      if (chains.are_joined(traits[u].chain_vertex, traits[v].chain_vertex))
        result.sharp_chords.emplace_back(u, v);
    }
    return result;
  } catch (const std::bad_alloc&) {
    throw;  // the job ends OUT_OF_MEMORY, not INTERNAL
  } catch (const std::exception& e) {
    return internal_error(fmt::format("the skin nodes could not be placed: {}", e.what()));
  }
}

}  // namespace skinframe
