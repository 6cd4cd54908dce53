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

// How firmly a node stands: only a less firm one gives way, or one of the same chain to the next on it.
enum class Hold { kFree, kOnChain, kFixed };
Hold hold_of(const NodeTraits& node, const SharpChains& chains) {
  if (node.pinned || chains.is_corner(node.chain_vertex)) return Hold::kFixed;
  return node.chain_vertex >= 0 ? Hold::kOnChain : Hold::kFree;
}

struct HeldOrMidpoint {
  NodeTraitsMap traits;
  const SharpChains* chains;
  template <class Profile>
  boost::optional<Kernel::Point_3> operator()(const Profile& profile) const {
    const NodeTraits &a = traits[profile.v0()], &b = traits[profile.v1()];
    const Hold hold_a = hold_of(a, *chains), hold_b = hold_of(b, *chains);
    if (hold_a == Hold::kFree && hold_b == Hold::kFree) return CGAL::midpoint(profile.p0(), profile.p1());
    if (hold_a == Hold::kFixed && hold_b == Hold::kFixed) return boost::none;
    if (hold_a == Hold::kFree) return profile.p1();
    if (hold_b == Hold::kFree) return profile.p0();
    if (!chains->are_joined(a.chain_vertex, b.chain_vertex)) return boost::none;
    return hold_b == Hold::kFixed ? profile.p1() : profile.p0();
  }
};

// The vertex that stays takes the traits of both, and the firmer one's place on its chain.
struct InheritTraits : sms::Edge_collapse_visitor_base<HalfEdgeMesh> {
  using vertex_descriptor = HalfEdgeMesh::Vertex_index;
  InheritTraits(NodeTraitsMap map, SharpChains* all) : traits(map), chains(all) {}
  void OnCollapsing(const Profile& profile, const boost::optional<Point>&) {
    const NodeTraits &a = traits[profile.v0()], &b = traits[profile.v1()];
    const bool a_stays = hold_of(a, *chains) >= hold_of(b, *chains);
    const NodeTraits &firmer = a_stays ? a : b, &other = a_stays ? b : a;
    merged = {0.5 * (a.edge_length_mm + b.edge_length_mm), a.pinned || b.pinned, firmer.chain_vertex};
    given_up = other.chain_vertex;
  }
  void OnCollapsed(const Profile&, vertex_descriptor kept) {
    traits[kept] = merged;
    if (given_up >= 0) chains->drop(given_up);
  }
  NodeTraitsMap traits;
  SharpChains* chains;
  NodeTraits merged;
  int given_up = -1;
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

void collapse_to_count(HalfEdgeMesh& mesh, NodeTraitsMap traits, SharpChains& chains, int nodes) {
  const auto surplus = static_cast<std::ptrdiff_t>(mesh.number_of_vertices()) - nodes;
  if (surplus <= 0) return;
  const auto edges = static_cast<std::ptrdiff_t>(mesh.number_of_edges()) - 3 * surplus;
  if (edges <= 0) return;
  sms::edge_collapse(mesh, AtEdgeCount{static_cast<std::size_t>(edges)},
                     CGAL::parameters::get_cost(RelativeLengthCost{traits})
                         .get_placement(HeldOrMidpoint{traits, &chains})
                         .visitor(InheritTraits(traits, &chains)));
  mesh.collect_garbage();
}

}  // namespace skinframe
