// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/fine_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "worker/frame/on_m1.h"
#include "worker/verify/relax_skin.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Edge = std::pair<int, int>;
using Triangle = std::array<int, 3>;

// A node that would travel further than this share of its edge, or to where M1 looks another way, goes along
// the normal: there M1 has a ridge.
constexpr double kFurthestInEdges = 0.4;
constexpr double kFurthestAlongNormal = 1.0;  // in edges; otherwise it stays on the chord
constexpr double kLooksAlike = 0.3;           // cosine, of M1 and the triangles beside
constexpr int kRimRings = 2;                  // of triangles on either side of the rim
constexpr double kLeastSlope = 0.2;           // sine, of the surface where nodes are moved onto the rim
constexpr double kFurthestToRim = 0.45;       // of the edge that crosses it

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class Refiner {
 public:
  Refiner(const Frame& frame, const Skin& skin) : skin_(skin), own_nodes_(frame.skin_node_count) {
    out_.frame.nodes_mm.assign(frame.nodes_mm.begin(), frame.nodes_mm.begin() + frame.skin_node_count);
    out_.frame.skin_triangles = frame.skin_triangles;
    for (const Strut& strut : frame.struts)
      out_.chains.push_back(strut.is_skin ? std::vector<int>{strut.a, strut.b} : std::vector<int>{});
  }

  void divide_all() { divide(std::vector<char>(out_.frame.skin_triangles.size(), 1)); }

  // Triangles within kRimRings of one with nodes on both sides of the height.
  void divide_rim(double height_mm) {
    const auto& triangles = out_.frame.skin_triangles;
    std::vector<char> near(out_.frame.nodes_mm.size(), 0), wanted(triangles.size(), 0);
    const auto grow = [&](const auto& belongs) {
      std::vector<char> grown = near;
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (!belongs(triangles[t])) continue;
        wanted[t] = 1;
        for (const int v : triangles[t]) grown[v] = 1;
      }
      near = std::move(grown);
    };
    grow([&](const Triangle& t) {
      const int below = is_below(t[0], height_mm) + is_below(t[1], height_mm) + is_below(t[2], height_mm);
      return below == 1 || below == 2;
    });
    for (int ring = 0; ring < kRimRings; ++ring)
      grow([&](const Triangle& t) { return near[t[0]] || near[t[1]] || near[t[2]]; });
    divide(std::move(wanted));
  }

  // Nodes at or below the height, after those that are nearest to the rim along an edge have moved onto it.
  void mark_contact(double height_mm) {
    auto& nodes = out_.frame.nodes_mm;
    struct Move {
      double share = kFurthestToRim;  // of the edge
      int towards = -1;
    };
    std::vector<Move> moves(nodes.size());
    for (const Triangle& t : out_.frame.skin_triangles)
      for (int k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        if (is_below(a, height_mm) == is_below(b, height_mm)) continue;
        const double share = (height_mm - nodes[a].z()) / (nodes[b].z() - nodes[a].z());
        if (a >= own_nodes_ && share < moves[a].share) moves[a] = {share, b};
        if (b >= own_nodes_ && 1 - share < moves[b].share) moves[b] = {1 - share, a};
      }
    std::vector<Vector3d> moved = nodes;
    out_.in_contact.resize(nodes.size());
    for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
      out_.in_contact[i] = is_below(i, height_mm);
      if (moves[i].towards < 0) continue;
      const Vector3d edge = nodes[moves[i].towards] - nodes[i];
      const auto rim = onto_rim(nodes[i] + moves[i].share * edge, height_mm);
      if (!rim || (*rim - nodes[i]).norm() > kFurthestToRim * edge.norm()) continue;
      moved[i] = *rim;
      out_.in_contact[i] = 1;
    }
    nodes = std::move(moved);
  }

  FineSkin finish() {
    auto& nodes = out_.frame.nodes_mm;
    out_.frame.skin_node_count = static_cast<int>(nodes.size());
    out_.in_contact.resize(nodes.size(), 0);
    out_.normals.assign(nodes.size(), Vector3d::Zero());
    for (const auto& t : out_.frame.skin_triangles) {
      const Vector3d twice = (nodes[t[1]] - nodes[t[0]]).cross(nodes[t[2]] - nodes[t[0]]);
      for (const int v : t) out_.normals[v] += twice;
    }
    for (Vector3d& n : out_.normals) n = n.norm() > 0 ? Vector3d(n.normalized()) : Vector3d::UnitZ();
    return std::move(out_);
  }

 private:
  bool is_below(int i, double height_mm) const { return out_.frame.nodes_mm[i].z() <= height_mm; }

  // The wanted triangles in four, and those that share two edges with them; those that share one, in two.
  void divide(std::vector<char> wanted) {
    const auto& triangles = out_.frame.skin_triangles;
    std::map<Edge, int> middle;  // -1: to be made
    for (bool more = true; more;) {
      more = false;
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        int marked = 0;
        for (int k = 0; k < 3; ++k)
          marked += middle.contains(edge_of(triangles[t][k], triangles[t][(k + 1) % 3]));
        if (marked == 3 || (marked < 2 && !wanted[t])) continue;
        for (int k = 0; k < 3; ++k)
          middle.try_emplace(edge_of(triangles[t][k], triangles[t][(k + 1) % 3]), -1);
        more = true;
      }
    }
    std::map<Edge, Vector3d> normal;  // of the triangles beside
    for (const Triangle& t : triangles)
      for (int k = 0; k < 3; ++k) {
        const Edge edge = edge_of(t[k], t[(k + 1) % 3]);
        if (!middle.contains(edge)) continue;
        const auto& p = out_.frame.nodes_mm;
        normal.try_emplace(edge, Vector3d::Zero()).first->second +=
            (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).stableNormalized();
      }
    const auto middle_of = [&](int a, int b) {
      const auto it = middle.find(edge_of(a, b));
      if (it == middle.end()) return -1;
      if (it->second < 0) it->second = add_middle(a, b, normal.at(it->first).stableNormalized());
      return it->second;
    };
    std::vector<Triangle> finer;
    finer.reserve(4 * triangles.size());
    for (const Triangle& t : triangles) {
      const Triangle m{middle_of(t[0], t[1]), middle_of(t[1], t[2]), middle_of(t[2], t[0])};
      if (m[0] >= 0 && m[1] >= 0 && m[2] >= 0) {
        finer.insert(finer.end(), {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, m});
        continue;
      }
      const int k = m[0] >= 0 ? 0 : m[1] >= 0 ? 1 : 2;
      if (m[k] < 0) {
        finer.push_back(t);
        continue;
      }
      finer.push_back({t[k], m[k], t[(k + 2) % 3]});
      finer.push_back({m[k], t[(k + 1) % 3], t[(k + 2) % 3]});
    }
    out_.frame.skin_triangles = std::move(finer);
    relax_skin(skin_, own_nodes_, &out_.frame);
    for (auto& chain : out_.chains) {
      std::vector<int> longer;
      for (std::size_t i = 0; i < chain.size(); ++i) {
        longer.push_back(chain[i]);
        if (const int between = i + 1 < chain.size() ? middle_of(chain[i], chain[i + 1]) : -1; between >= 0)
          longer.push_back(between);
      }
      chain = std::move(longer);
    }
  }

  int add_middle(int a, int b, const Vector3d& normal) {
    auto& nodes = out_.frame.nodes_mm;
    const Vector3d chord = (nodes[a] + nodes[b]) / 2;
    const double edge = (nodes[b] - nodes[a]).norm();
    const auto looks_alike = [&](const Vector3d& p) {
      return skin_.field.gradient(p).stableNormalized().dot(normal) >= kLooksAlike;
    };
    Vector3d placed = onto_m1(chord, skin_);
    if ((placed - chord).norm() > kFurthestInEdges * edge || !looks_alike(placed)) {
      const auto ahead = first_on_m1(chord, normal, kFurthestAlongNormal * edge, skin_);
      placed = ahead && looks_alike(*ahead) ? *ahead : chord;
    }
    nodes.push_back(placed);
    return static_cast<int>(nodes.size()) - 1;
  }

  // From a point near to both M1 and the height to one on both; none where M1 is too flat there.
  std::optional<Vector3d> onto_rim(Vector3d p, double height_mm) const {
    for (int step = 0; step < 3; ++step) {
      p = onto_m1(p, skin_);
      const Vector3d normal = skin_.field.gradient(p).stableNormalized();
      const Vector3d uphill = Vector3d::UnitZ() - normal.z() * normal;  // its z is the slope's sine squared
      if (uphill.z() < kLeastSlope * kLeastSlope) return std::nullopt;
      p += (height_mm - p.z()) / uphill.z() * uphill;
    }
    return p;
  }

  const Skin& skin_;
  const int own_nodes_;
  FineSkin out_;
};

}  // namespace

FineSkin refine_skin(const Frame& frame, const Skin& skin, int levels,
                     const std::optional<double>& contact_below_mm) {
  Refiner refiner(frame, skin);
  for (int level = 0; level < levels; ++level) refiner.divide_all();
  if (contact_below_mm) {
    for (int level = 0; level < kRimLevels; ++level) refiner.divide_rim(*contact_below_mm);
    refiner.mark_contact(*contact_below_mm);
  }
  return refiner.finish();
}

std::size_t fine_node_count(const Frame& frame, int levels) {
  return static_cast<std::size_t>(frame.skin_node_count) << (2 * levels);
}

}  // namespace skinframe
