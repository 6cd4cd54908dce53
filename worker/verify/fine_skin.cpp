// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/fine_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "worker/frame/on_m1.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Edge = std::pair<int, int>;

// A node that would travel further than this share of its edge stays on the chord: there M1 has a ridge.
constexpr double kFurthestInEdges = 0.4;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class Refiner {
 public:
  Refiner(const Frame& frame, const Skin& skin) : skin_(skin) {
    out_.frame.nodes_mm.assign(frame.nodes_mm.begin(), frame.nodes_mm.begin() + frame.skin_node_count);
    out_.frame.skin_triangles = frame.skin_triangles;
    for (const Strut& strut : frame.struts)
      out_.chains.push_back(strut.is_skin ? std::vector<int>{strut.a, strut.b} : std::vector<int>{});
  }

  void divide() {
    middle_.clear();
    std::vector<std::array<int, 3>> finer;
    finer.reserve(4 * out_.frame.skin_triangles.size());
    for (const auto& t : out_.frame.skin_triangles) {
      const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    out_.frame.skin_triangles = std::move(finer);
    for (auto& chain : out_.chains) {
      std::vector<int> longer;
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        longer.push_back(chain[i]);
        longer.push_back(middle(chain[i], chain[i + 1]));
      }
      if (!chain.empty()) longer.push_back(chain.back());
      chain = std::move(longer);
    }
  }

  FineSkin finish() {
    auto& nodes = out_.frame.nodes_mm;
    out_.frame.skin_node_count = static_cast<int>(nodes.size());
    out_.normals.assign(nodes.size(), Vector3d::Zero());
    for (const auto& t : out_.frame.skin_triangles) {
      const Vector3d twice = (nodes[t[1]] - nodes[t[0]]).cross(nodes[t[2]] - nodes[t[0]]);
      for (const int v : t) out_.normals[v] += twice;
    }
    for (Vector3d& n : out_.normals) n = n.norm() > 0 ? Vector3d(n.normalized()) : Vector3d::UnitZ();
    return std::move(out_);
  }

 private:
  int middle(int a, int b) {
    auto& nodes = out_.frame.nodes_mm;
    const auto [it, fresh] = middle_.try_emplace(edge_of(a, b), static_cast<int>(nodes.size()));
    if (!fresh) return it->second;
    const Vector3d chord = (nodes[a] + nodes[b]) / 2, placed = onto_m1(chord, skin_);
    const double reach = kFurthestInEdges * (nodes[b] - nodes[a]).norm();
    nodes.push_back((placed - chord).norm() <= reach ? placed : chord);
    out_.parents.push_back({a, b});
    return it->second;
  }

  const Skin& skin_;
  FineSkin out_;
  std::map<Edge, int> middle_;
};

}  // namespace

FineSkin refine_skin(const Frame& frame, const Skin& skin, int levels) {
  Refiner refiner(frame, skin);
  for (int level = 0; level < levels; ++level) refiner.divide();
  return refiner.finish();
}

std::size_t fine_node_count(const Frame& frame, int levels) {
  return static_cast<std::size_t>(frame.skin_node_count) << (2 * levels);
}

}  // namespace skinframe
