// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/vertex_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace skinframe {

VertexGraph vertex_graph(const TriangleMesh& mesh) {
  const std::size_t n = mesh.vertices.size();
  VertexGraph graph;
  graph.first.assign(n + 1, 0);
  for (const auto& t : mesh.triangles) {
    for (int v : t) graph.first[v + 1] += 2;
  }
  std::partial_sum(graph.first.begin(), graph.first.end(), graph.first.begin());
  std::vector<int> all(graph.first[n]);
  std::vector<int> next(graph.first.begin(), graph.first.end() - 1);
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      all[next[t[k]]++] = t[(k + 1) % 3];
      all[next[t[k]]++] = t[(k + 2) % 3];
    }
  }
  graph.neighbour.reserve(all.size() / 2);
  for (std::size_t v = 0; v < n; ++v) {
    const auto begin = all.begin() + graph.first[v], end = all.begin() + graph.first[v + 1];
    std::sort(begin, end);
    const auto last = std::unique(begin, end);
    graph.first[v] = static_cast<int>(graph.neighbour.size());
    graph.neighbour.insert(graph.neighbour.end(), begin, last);
  }
  graph.first[n] = static_cast<int>(graph.neighbour.size());
  return graph;
}

std::vector<double> vertex_areas(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size(), 0.0);
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const double area = 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    for (int v : t) areas[v] += area / 3.0;
  }
  return areas;
}

std::vector<TriangleMesh> split_pieces(const TriangleMesh& mesh) {
  const VertexGraph graph = vertex_graph(mesh);
  std::vector<int> piece(mesh.vertices.size(), -1), place(mesh.vertices.size(), 0);
  std::vector<TriangleMesh> pieces;
  for (std::size_t seed = 0; seed < piece.size(); ++seed) {
    if (piece[seed] >= 0 || graph.first[seed] == graph.first[seed + 1]) continue;
    const int index = static_cast<int>(pieces.size());
    TriangleMesh part;
    std::vector<int> todo{static_cast<int>(seed)};
    piece[seed] = index;
    while (!todo.empty()) {
      const int v = todo.back();
      todo.pop_back();
      place[v] = static_cast<int>(part.vertices.size());
      part.vertices.push_back(mesh.vertices[v]);
      for (int i = graph.first[v]; i < graph.first[v + 1]; ++i) {
        const int w = graph.neighbour[i];
        if (piece[w] >= 0) continue;
        piece[w] = index;
        todo.push_back(w);
      }
    }
    pieces.push_back(std::move(part));
  }
  for (const auto& t : mesh.triangles) {
    pieces[piece[t[0]]].triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  }
  std::vector<std::pair<double, int>> order;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    order.emplace_back(-surface_area(pieces[i]), static_cast<int>(i));
  }
  std::sort(order.begin(), order.end());
  std::vector<TriangleMesh> sorted;
  for (const auto& [area, i] : order) sorted.push_back(std::move(pieces[i]));
  return sorted;
}

}  // namespace skinframe
