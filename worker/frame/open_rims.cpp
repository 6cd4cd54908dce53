// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/open_rims.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace skinframe {
namespace {

constexpr double kOnRim = 0.02;      // of the rim's radius: its chords' middles stand 0.034 within
constexpr double kWithin = 0.94;     // of the rim's radius
constexpr double kLeastSlack = 0.5;  // of kRimSlackMm, beside any strut of the skin

// A vertex as it stands to the axis.
struct Place {
  Eigen::Vector2d beside;
  double along;
};

using Sides = std::map<std::pair<int, int>, int>;  // of triangles, by their directed edges
using Triangles = std::vector<std::array<int, 3>>;

// Triangles outside of the rim whose corners all stand on it lie across the opening: there the surface beyond
// is folded back. With the triangle that they hang on by their one other side they become a fan about its
// far corner. `sides` is not kept up to date.
void unfold(Triangles& triangles, const std::vector<char>& within, const Sides& sides,
            const std::set<std::pair<int, int>>& on_chain) {
  std::set<int> on_rim;
  for (const auto& [a, b] : on_chain) on_rim.insert({a, b});
  const auto is_folded = [&](int t) {
    return !within[t] &&
           std::all_of(triangles[t].begin(), triangles[t].end(), [&](int v) { return on_rim.count(v) > 0; });
  };
  std::vector<int> folded;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    if (is_folded(t)) folded.push_back(t);
  std::set<int> seen;
  for (const int first : folded) {
    if (!seen.insert(first).second) continue;
    std::vector<int> flap{first};
    std::vector<std::pair<int, int>> rim, hinge;
    for (std::size_t i = 0; i < flap.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const int a = triangles[flap[i]][k], b = triangles[flap[i]][(k + 1) % 3];
        const auto beyond = sides.find({b, a});
        if (on_chain.count(std::minmax(a, b)) > 0) {
          rim.emplace_back(a, b);
        } else if (beyond == sides.end() ||
                   !std::binary_search(folded.begin(), folded.end(), beyond->second)) {
          hinge.emplace_back(a, b);
        } else if (seen.insert(beyond->second).second) {
          flap.push_back(beyond->second);
        }
      }
    if (hinge.size() != 1 || rim.size() != flap.size() + 1) continue;
    const auto [a, b] = hinge.front();
    const auto holder = sides.find({b, a});
    if (holder == sides.end() || !seen.insert(holder->second).second) continue;
    int far = -1;
    for (const int v : triangles[holder->second])
      if (v != a && v != b) far = v;
    const bool is_free = std::all_of(rim.begin(), rim.end(), [&](const auto& side) {
      return side.second == a || sides.count({side.second, far}) + sides.count({far, side.second}) == 0;
    });
    if (!is_free) continue;
    flap.push_back(holder->second);
    for (std::size_t i = 0; i < flap.size(); ++i) triangles[flap[i]] = {rim[i].first, rim[i].second, far};
  }
}

}  // namespace

bool open_rim(TriangleMesh& mesh, std::vector<std::pair<int, int>>& chords, const Opening& opening,
              double skin_thickness_mm) {
  const Across to = across(opening);
  const double rim = rim_radius_mm(opening, skin_thickness_mm);
  std::vector<Place> places;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    const Eigen::Vector3d from = p - opening.centre_mm;
    places.push_back({{from.dot(to.u), from.dot(to.v)}, from.dot(opening.axis)});
  }
  const auto is_near = [&](int v) {
    return std::abs(places[v].along) <= opening.clear_mm + opening.rise_mm &&
           places[v].beside.norm() <= (1.0 + kOnRim) * rim;
  };
  const auto on_rim = [&](int v) { return is_near(v) && places[v].beside.norm() >= kWithin * rim; };
  std::set<std::pair<int, int>> on_chain;
  for (const auto& [a, b] : chords)
    if (on_rim(a) && on_rim(b)) on_chain.insert(std::minmax(a, b));

  Sides sides;
  std::vector<int> todo;
  std::vector<char> within(mesh.triangles.size(), 0);
  const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
    return u.x() * v.y() - u.y() * v.x();
  };
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& corners = mesh.triangles[t];
    bool about_axis = true;
    for (int k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      sides[{a, b}] = t;
      about_axis = about_axis && is_near(a) && cross(places[a].beside, places[b].beside) >= 0.0;
    }
    if (!about_axis) continue;
    within[t] = 1;
    todo.push_back(t);
  }
  if (todo.empty()) return false;
  while (!todo.empty()) {
    const int t = todo.back();
    todo.pop_back();
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (!is_near(a)) return false;  // through a gap of the chain
      if (on_chain.count(std::minmax(a, b)) > 0) continue;
      const auto beyond = sides.find({b, a});
      if (beyond == sides.end()) return false;
      if (within[beyond->second]) continue;
      within[beyond->second] = 1;
      todo.push_back(beyond->second);
    }
  }

  Triangles triangles = mesh.triangles;
  unfold(triangles, within, sides, on_chain);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < within.size(); ++t) {
    if (within[t]) continue;
    triangles[kept++] = triangles[t];
    for (int k = 0; k < 3; ++k)
      if (distance_mm(opening, mesh.vertices[triangles[t][k]], mesh.vertices[triangles[t][(k + 1) % 3]]) <
          skin_thickness_mm + kLeastSlack * kRimSlackMm)
        return false;
  }
  triangles.resize(kept);
  mesh.triangles = std::move(triangles);
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const auto& t : mesh.triangles)
    for (const int v : t) number[v] = 0;
  int count = 0;
  for (int& n : number)
    if (n == 0) n = count++;
  drop_unused_vertices(mesh);  // which numbers them so
  std::erase_if(chords,
                [&](const auto& chord) { return number[chord.first] < 0 || number[chord.second] < 0; });
  for (auto& [a, b] : chords) {
    a = number[a];
    b = number[b];
  }
  return true;
}

bool has_rim(const TriangleMesh& piece, const SharpCurve& rim, double reach_mm) {
  return !rim.points_mm.empty() &&
         std::any_of(piece.vertices.begin(), piece.vertices.end(), [&](const Eigen::Vector3d& p) {
           return (p - rim.points_mm.front()).norm() <= reach_mm;
         });
}

}  // namespace skinframe
