// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/sharp_chains.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>

#include "worker/frame/point_tree.h"
#include "worker/frame/vertex_graph.h"
#include "worker/run/result.h"

namespace skinframe {
namespace {

constexpr double kCostOfDistance = 4.0;  // of a path's way, for each mm that it stands off the curve
constexpr double kSameCornerInReaches = 0.7;
constexpr double kApartInReaches = 2.5;
constexpr double kLeastLengthInReaches = 16.0;  // facets of coarse round bodies have shorter ones
constexpr int kArcsOfALoop = 3;
constexpr double kApartInShares = 0.1;  // of even spacing, between vertices along a curve

std::vector<std::vector<Eigen::Vector3d>> arcs_of(const SharpCurve& curve) {
  if (!curve.closed) return {curve.points_mm};
  std::vector<std::vector<Eigen::Vector3d>> arcs;
  const std::size_t last = curve.points_mm.size() - 1;
  const std::size_t count = curve.corners > 0 ? curve.corners : kArcsOfALoop;
  for (std::size_t i = 0; i < count; ++i)
    arcs.emplace_back(curve.points_mm.begin() + static_cast<std::ptrdiff_t>(i * last / count),
                      curve.points_mm.begin() + static_cast<std::ptrdiff_t>((i + 1) * last / count + 1));
  return arcs;
}

// The curves that, away from their ends, come nowhere nearer than that to another: on a thin plate vertices
// cannot be told to be of the one or the other.
std::vector<char> stand_apart(const std::vector<SharpCurve>& curves, double distance) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> owner;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    points.insert(points.end(), curves[i].points_mm.begin(), curves[i].points_mm.end());
    owner.resize(points.size(), i);
  }
  const PointTree tree(std::move(points));
  std::vector<char> apart(curves.size(), 1);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const SharpCurve& curve = curves[i];
    const double from_ends = curve.closed ? 0.0 : 2.0 * distance;
    const Eigen::Vector3d &first = curve.points_mm.front(), &last = curve.points_mm.back();
    for (const Eigen::Vector3d& p : curve.points_mm) {
      if ((p - first).norm() < from_ends || (p - last).norm() < from_ends) continue;
      const auto near = tree.within(p, distance);
      if (std::any_of(near.begin(), near.end(), [&](int k) { return owner[k] != i; })) apart[i] = 0;
    }
  }
  return apart;
}

}  // namespace

// Paths of the piece's edges along curves.
class ChainFinder {
 public:
  ChainFinder(const TriangleMesh& piece, double reach, const SharpChains& chains)
      : places_(piece.vertices), graph_(vertex_graph(piece)), reach_(reach), chains_(chains) {}

  // From the vertex nearest to the arc's start to that at its end; empty when there is none. No vertex of
  // another chain but for shared corners.
  std::vector<int> along(const SharpChains::Chain& chain) const {
    const int start = end_at(chain.points_mm.front()), goal = end_at(chain.points_mm.back());
    if (start < 0 || goal < 0 || start == goal) return {};
    std::map<int, double> off;  // of the vertices near the arc: their distance from it
    for (const Eigen::Vector3d& p : chain.points_mm)
      for (const int v : places_.within(p, reach_)) off.try_emplace(v, 0.0);
    for (auto& [v, distance] : off)
      distance = (chain.at(chain.nearest(places_.point(v))) - places_.point(v)).norm();
    off.try_emplace(start, 0.0);
    off.try_emplace(goal, 0.0);
    return shortest(start, goal, off);
  }

 private:
  bool is_free(int v) const { return chains_.role(v) == SharpChains::Role::kNone; }

  // A corner that is there already, or a vertex of no chain.
  int end_at(const Eigen::Vector3d& p) const {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const int v : places_.within(p, 2.0 * reach_)) {
      if (chains_.role(v) == SharpChains::Role::kInner) continue;
      // A corner has been moved to where its curves meet.
      const bool corner = chains_.is_corner(v);
      const double distance = corner ? (chains_.corner_mm(v) - p).norm() : (places_.point(v) - p).norm();
      if (corner && distance < kSameCornerInReaches * reach_) return v;
      if (!corner && distance < least) {
        least = distance;
        best = v;
      }
    }
    return best;
  }

  std::vector<int> shortest(int start, int goal, const std::map<int, double>& off) const {
    std::map<int, std::pair<double, int>> reached{{start, {0.0, -1}}};
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.emplace(0.0, start);
    while (!queue.empty() && queue.top().second != goal) {
      const auto [way, v] = queue.top();
      queue.pop();
      if (way > reached.at(v).first) continue;
      for (int i = graph_.first[v]; i < graph_.first[v + 1]; ++i) {
        const int w = graph_.neighbour[i];
        const auto distance = off.find(w);
        if (distance == off.end() || (w != goal && !is_free(w))) continue;
        const double there =
            way + (places_.point(w) - places_.point(v)).norm() + kCostOfDistance * distance->second;
        const auto [it, fresh] = reached.try_emplace(w, there, v);
        if (!fresh && there >= it->second.first) continue;
        it->second = {there, v};
        queue.emplace(there, w);
      }
    }
    if (reached.count(goal) == 0) return {};
    std::vector<int> path;
    for (int v = goal; v >= 0; v = reached.at(v).second) path.push_back(v);
    std::reverse(path.begin(), path.end());
    return path;
  }

  PointTree places_;
  VertexGraph graph_;
  double reach_;
  const SharpChains& chains_;
};

SharpChains::SharpChains(TriangleMesh& piece, const std::vector<SharpCurve>& curves, double reach)
    : roles_(piece.vertices.size(), Role::kNone), links_(piece.vertices.size()) {
  if (curves.empty()) return;
  const ChainFinder finder(piece, reach, *this);
  const auto apart = stand_apart(curves, kApartInReaches * reach);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const bool wanted = curves[i].corners > 0;
    if (!wanted && (!apart[i] || curves[i].length_mm() < kLeastLengthInReaches * reach)) continue;
    for (const auto& points : arcs_of(curves[i])) {
      const Chain chain = chain_of(points);
      const auto path = finder.along(chain);
      if (path.size() > 1) add(piece, chain, path, wanted);
    }
  }
}

SharpChains::Chain SharpChains::chain_of(const std::vector<Eigen::Vector3d>& points) {
  Chain chain{points, {0.0}, 0};
  for (std::size_t i = 1; i < points.size(); ++i)
    chain.along_mm.push_back(chain.along_mm.back() + (points[i] - points[i - 1]).norm());
  return chain;
}

void SharpChains::add(TriangleMesh& piece, const Chain& chain, const std::vector<int>& path,
                      bool keeps_its_ends) {
  const int number = static_cast<int>(chains_.size());
  for (const int end : {path.front(), path.back()}) {
    if (roles_[end] == Role::kCorner) continue;
    roles_[end] = Role::kCorner;
    corners_mm_[end] = end == path.front() ? chain.points_mm.front() : chain.points_mm.back();
    piece.vertices[end] = corners_mm_[end];
  }
  // Never back, for paths may turn a little where the surface is bevelled, and never two in one place: an
  // edge without length is collapsed before anything is asked.
  const std::size_t inner = path.size() - 2;
  const double apart = kApartInShares * chain.length() / static_cast<double>(inner + 1);
  std::vector<double> along(path.size(), 0.0);
  along.back() = chain.length();
  for (std::size_t i = 1; i <= inner; ++i)
    along[i] = std::max(along[i - 1] + apart, chain.nearest(piece.vertices[path[i]]));
  for (std::size_t i = inner; i >= 1; --i) along[i] = std::min(along[i], along[i + 1] - apart);
  for (std::size_t i = 1; i <= inner; ++i) {
    const int v = path[i];
    roles_[v] = Role::kInner;
    links_[v] = {number, path[i - 1], path[i + 1], along[i]};
    piece.vertices[v] = chain.at(along[i]);
  }
  chains_.push_back(chain);
  chains_.back().inner = static_cast<int>(path.size()) - 2;
  if (keeps_its_ends) chain_between_[std::minmax(path.front(), path.back())] = number;
}

Eigen::Vector3d SharpChains::Chain::at(double along) const {
  const auto after = std::upper_bound(along_mm.begin(), along_mm.end(), along);
  if (after == along_mm.begin()) return points_mm.front();
  if (after == along_mm.end()) return points_mm.back();
  const auto i = static_cast<std::size_t>(after - along_mm.begin());
  const double share = (along - along_mm[i - 1]) / (along_mm[i] - along_mm[i - 1]);
  return points_mm[i - 1] + share * (points_mm[i] - points_mm[i - 1]);
}

double SharpChains::Chain::nearest(const Eigen::Vector3d& p) const {
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < points_mm.size(); ++i) {
    const Eigen::Vector3d step = points_mm[i] - points_mm[i - 1];
    const double share =
        std::clamp((p - points_mm[i - 1]).dot(step) / std::max(step.squaredNorm(), 1e-300), 0.0, 1.0);
    const double distance = (points_mm[i - 1] + share * step - p).norm();
    if (distance >= least) continue;
    least = distance;
    best = along_mm[i - 1] + share * (along_mm[i] - along_mm[i - 1]);
  }
  return best;
}

void SharpChains::drop(int vertex) {
  SKINFRAME_CHECK(role(vertex) == Role::kInner);
  const Link link = links_[vertex];
  roles_[vertex] = Role::kNone;
  --chains_[link.chain].inner;
  if (role(link.before) == Role::kInner) links_[link.before].after = link.after;
  if (role(link.after) == Role::kInner) links_[link.after].before = link.before;
}

Eigen::Vector3d SharpChains::slide(int vertex) {
  Link& link = links_[vertex];
  const Chain& chain = chains_[link.chain];
  const auto along = [&](int v, double at_corner) {
    return role(v) == Role::kInner ? links_[v].along_mm : at_corner;
  };
  link.along_mm = 0.5 * (along(link.before, 0.0) + along(link.after, chain.length()));
  return chain.at(link.along_mm);
}

std::vector<Eigen::Vector3d> SharpChains::points_mm() const {
  std::vector<Eigen::Vector3d> all;
  for (const Chain& chain : chains_) all.insert(all.end(), chain.points_mm.begin(), chain.points_mm.end());
  return all;
}

}  // namespace skinframe
