// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/mend_edges.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <unordered_set>

namespace skinframe {
namespace {

constexpr int kMaxRounds = 12;
constexpr double kNudge = 0.02;  // of the edge's length
constexpr double kLeastNudge =
    4.8e-7;  // of the largest coordinate: some floats, or the parts fall together again
constexpr std::size_t kVerticesABlock = 4096;

// One side of one triangle, beside others with the same lower end: eight bytes, since millions are sorted.
struct Side {
  std::uint32_t high;  // the upper end
  std::uint32_t triangle : 31;
  std::uint32_t forth : 1;  // run from the lower to the higher end
};

// One edge: its ends, and the sides that run along it.
struct Edge {
  int low, high;
  const Side *first, *last;
};

// By the lower end, the upper end, the triangle: counted into place by the lower end, then sorted among few.
struct SortedSides {
  std::vector<Side> sides;
  std::vector<int> first;  // of each lower end, and where the last one's end

  explicit SortedSides(const TriangleMesh& mesh);
  std::size_t vertices() const { return first.size() - 1; }
  // visit(edge) of every edge with that lower end.
  template <class Visit>
  void for_each_edge(int low, Visit visit) const {
    const Side *at = sides.data() + first[low], *end = sides.data() + first[low + 1];
    while (at != end) {
      const Side* next = at;
      while (next != end && next->high == at->high) ++next;
      visit(Edge{low, static_cast<int>(at->high), at, next});
      at = next;
    }
  }
};

SortedSides::SortedSides(const TriangleMesh& mesh) {
  const auto low_end = [](const std::array<int, 3>& t, int k) { return std::min(t[k], t[(k + 1) % 3]); };
  first.assign(mesh.vertices.size() + 1, 0);
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++first[low_end(t, k) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> next = first;
  sides.resize(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides[next[std::min(a, b)]++] = {static_cast<std::uint32_t>(std::max(a, b)),
                                       static_cast<std::uint32_t>(t), a < b};
    }
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices(), kVerticesABlock), [&](const auto& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v)
      std::sort(sides.begin() + first[v], sides.begin() + first[v + 1], [](const Side& x, const Side& y) {
        return x.high != y.high ? x.high < y.high : x.triangle < y.triangle;
      });
  });
}

bool is_good(const Edge& edge) {
  return edge.last - edge.first == 2 && edge.first[0].forth != edge.first[1].forth;
}

// In order.
std::vector<Edge> bad_edges(const SortedSides& sides) {
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, sides.vertices(), kVerticesABlock), std::vector<Edge>(),
      [&](const auto& range, std::vector<Edge> bad) {
        for (auto low = static_cast<int>(range.begin()); low < static_cast<int>(range.end()); ++low)
          sides.for_each_edge(low, [&](const Edge& edge) {
            if (!is_good(edge)) bad.push_back(edge);
          });
        return bad;
      },
      [](std::vector<Edge> bad, const std::vector<Edge>& more) {
        bad.insert(bad.end(), more.begin(), more.end());
        return bad;
      });
}

// Of each vertex the first one at the same place.
std::vector<int> keepers_of(const std::vector<Eigen::Vector3d>& vertices) {
  struct Place {
    std::array<float, 3> at;
    int vertex;
  };
  std::vector<Place> order(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Eigen::Vector3f at = vertices[i].cast<float>();
    order[i] = {{at.x(), at.y(), at.z()}, static_cast<int>(i)};
  }
  tbb::parallel_sort(order.begin(), order.end(), [](const Place& a, const Place& b) {
    return a.at != b.at ? a.at < b.at : a.vertex < b.vertex;
  });
  std::vector<int> keeper(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && order[i].at == order[i - 1].at;
    keeper[order[i].vertex] = same ? keeper[order[i - 1].vertex] : order[i].vertex;
  }
  return keeper;
}

void weld_equal_floats(TriangleMesh& mesh) {
  for (auto& v : mesh.vertices) v = v.cast<float>().cast<double>();
  const std::vector<int> keeper = keepers_of(mesh.vertices);
  std::vector<int> place(keeper.size(), -1);
  int used = 0;
  for (std::size_t i = 0; i < keeper.size(); ++i) {
    if (keeper[i] != static_cast<int>(i)) continue;
    place[i] = used;
    mesh.vertices[used++] = mesh.vertices[i];
  }
  mesh.vertices.resize(used);
  for (auto& t : mesh.triangles) {
    for (int& v : t) v = place[keeper[v]];
  }
  std::erase_if(mesh.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

// Two triangles on the same three corners, wound oppositely, enclose nothing.
void cancel_opposite_triangles(TriangleMesh& mesh) {
  std::vector<int> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  const auto sorted = [&](int i) {
    auto t = mesh.triangles[i];
    std::sort(t.begin(), t.end());
    return t;
  };
  const auto is_even = [&](int i) {
    const auto& t = mesh.triangles[i];
    return (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2;
  };
  tbb::parallel_sort(order.begin(), order.end(), [&](int i, int j) {
    const auto a = sorted(i), b = sorted(j);
    return a != b ? a < b : i < j;
  });
  std::vector<char> gone(mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < order.size();) {
    std::vector<int> even, odd;
    std::size_t j = i;
    for (; j < order.size() && sorted(order[j]) == sorted(order[i]); ++j) {
      (is_even(order[j]) ? even : odd).push_back(order[j]);
    }
    for (std::size_t k = 0; k < std::min(even.size(), odd.size()); ++k) gone[even[k]] = gone[odd[k]] = 1;
    i = j;
  }
  std::size_t used = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!gone[i]) mesh.triangles[used++] = mesh.triangles[i];
  }
  mesh.triangles.resize(used);
}

// A triangle at the edge u-v by its angle about the edge. Its outward normal points to larger angles when it
// runs u -> v (forth), so solid lies between a `back` triangle and the `forth` one that follows it.
struct Leaf {
  double angle;
  Side side;
};

std::vector<std::pair<Leaf, Leaf>> solid_wedges(std::vector<Leaf> leaves) {
  std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.side.triangle < b.side.triangle;
  });
  // Brackets round a circle: in two turns every `back` finds its `forth`.
  std::vector<std::pair<Leaf, Leaf>> wedges;
  std::vector<std::size_t> open;
  std::vector<char> done(leaves.size(), 0);
  for (std::size_t i = 0; i < 2 * leaves.size(); ++i) {
    const std::size_t k = i % leaves.size();
    if (done[k]) continue;
    if (!leaves[k].side.forth) {
      if (i < leaves.size()) open.push_back(k);
    } else if (!open.empty()) {
      wedges.emplace_back(leaves[open.back()], leaves[k]);
      done[open.back()] = done[k] = 1;
      open.pop_back();
    }
  }
  return wedges;
}

void split_side(TriangleMesh& mesh, int triangle, int a, int b, int middle) {
  auto& t = mesh.triangles[triangle];
  for (int k = 0; k < 3; ++k) {
    const int from = t[k], to = t[(k + 1) % 3], across = t[(k + 2) % 3];
    if (std::min(from, to) != std::min(a, b) || std::max(from, to) != std::max(a, b)) continue;
    t = {from, middle, across};
    mesh.triangles.push_back({middle, to, across});
    return;
  }
}

// Divides the edge between its wedges; false when it is not run as often forth as back.
bool part_wedges(TriangleMesh& mesh, const Edge& parted) {
  const int u = parted.low, v = parted.high;
  const Eigen::Vector3d origin = mesh.vertices[u], edge = mesh.vertices[v] - origin;
  const double nudge = std::max(kNudge * edge.norm(), kLeastNudge * origin.cwiseAbs().maxCoeff());
  const Eigen::Vector3d axis = edge.normalized();
  const Eigen::Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
  std::vector<Leaf> leaves;
  for (const Side* s = parted.first; s != parted.last; ++s) {
    const auto& t = mesh.triangles[s->triangle];
    const int w = t[0] + t[1] + t[2] - u - v;
    const Eigen::Vector3d arm = mesh.vertices[w] - origin;
    leaves.push_back({std::atan2(arm.dot(y), arm.dot(x)), *s});
  }
  const auto wedges = solid_wedges(std::move(leaves));
  if (2 * static_cast<std::ptrdiff_t>(wedges.size()) != parted.last - parted.first) return false;
  for (const auto& [back, forth] : wedges) {
    double opening = forth.angle - back.angle;
    if (opening < 0) opening += 2.0 * std::numbers::pi;
    const double middle_angle = back.angle + 0.5 * opening;
    const Eigen::Vector3d inward = std::cos(middle_angle) * x + std::sin(middle_angle) * y;
    const Eigen::Vector3d middle = origin + 0.5 * edge + nudge * inward;
    const int index = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(middle.cast<float>().cast<double>());
    split_side(mesh, back.side.triangle, u, v, index);
    split_side(mesh, forth.side.triangle, u, v, index);
  }
  return true;
}

}  // namespace

int count_bad_edges(const TriangleMesh& mesh) {
  return static_cast<int>(bad_edges(SortedSides(mesh)).size());
}

EdgeMending mend_edges(TriangleMesh& mesh) {
  EdgeMending result;
  for (int round = 0; round < kMaxRounds; ++round) {
    weld_equal_floats(mesh);
    const SortedSides sides(mesh);
    const std::vector<Edge> bad = bad_edges(sides);
    if (bad.empty()) {
      result.manifold = true;
      return result;
    }
    if (round == 0) {
      const std::size_t before = mesh.triangles.size();
      cancel_opposite_triangles(mesh);
      if (mesh.triangles.size() != before) continue;
    }
    // A triangle is divided once a round, so that the sides found above stay true.
    std::unordered_set<int> touched;
    for (const Edge& edge : bad) {
      if (std::any_of(edge.first, edge.last, [&](const Side& s) { return touched.contains(s.triangle); }))
        continue;
      for (const Side* s = edge.first; s != edge.last; ++s) touched.insert(s->triangle);
      if (!part_wedges(mesh, edge)) return result;
      ++result.edges_split;
    }
  }
  return result;
}

}  // namespace skinframe
