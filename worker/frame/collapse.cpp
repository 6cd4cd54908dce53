// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <cmath>

#include "worker/frame/half_edge.h"

namespace skinframe {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;

// Squared length in units of the wanted length, smallest first: the short and the too dense go first.
struct RelativeLengthCost {
  NodeTraitsMap traits;
  template <class Profile>
  boost::optional<double> operator()(const Profile& profile, const boost::optional<Kernel::Point_3>&) const {
    const double a = 0.5 * (traits[profile.v0()].edge_length_mm + traits[profile.v1()].edge_length_mm);
    return CGAL::squared_distance(profile.p0(), profile.p1()) / (a * a);
  }
};

struct PinnedMidpoint {
  NodeTraitsMap traits;
  template <class Profile>
  boost::optional<Kernel::Point_3> operator()(const Profile& profile) const {
    const bool pinned0 = traits[profile.v0()].pinned, pinned1 = traits[profile.v1()].pinned;
    if (pinned0 && pinned1) return boost::none;
    if (pinned0) return profile.p0();
    if (pinned1) return profile.p1();
    return CGAL::midpoint(profile.p0(), profile.p1());
  }
};

// The vertex that stays takes the traits of both.
struct InheritTraits : sms::Edge_collapse_visitor_base<HalfEdgeMesh> {
  using vertex_descriptor = HalfEdgeMesh::Vertex_index;
  explicit InheritTraits(NodeTraitsMap map) : traits(map) {}
  void OnCollapsing(const Profile& profile, const boost::optional<Point>&) {
    const NodeTraits &a = traits[profile.v0()], &b = traits[profile.v1()];
    merged = {0.5 * (a.edge_length_mm + b.edge_length_mm), a.pinned || b.pinned};
  }
  void OnCollapsed(const Profile&, vertex_descriptor kept) { traits[kept] = merged; }
  NodeTraitsMap traits;
  NodeTraits merged;
};

// A collapse on a closed surface takes three edges and one vertex.
struct AtEdgeCount {
  std::size_t edges;
  template <class Profile>
  bool operator()(double, const Profile&, std::size_t, std::size_t current) const {
    return current <= edges;
  }
};

}  // namespace

void collapse_to_count(HalfEdgeMesh& mesh, NodeTraitsMap traits, int nodes) {
  const auto surplus = static_cast<std::ptrdiff_t>(mesh.number_of_vertices()) - nodes;
  if (surplus <= 0) return;
  const auto edges = static_cast<std::ptrdiff_t>(mesh.number_of_edges()) - 3 * surplus;
  if (edges <= 0) return;
  sms::edge_collapse(mesh, AtEdgeCount{static_cast<std::size_t>(edges)},
                     CGAL::parameters::get_cost(RelativeLengthCost{traits})
                         .get_placement(PinnedMidpoint{traits})
                         .visitor(InheritTraits(traits)));
  mesh.collect_garbage();
}

}  // namespace skinframe
