// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "worker/solid/half_edges.h"
#include "worker/solid/weld.h"

namespace skinframe {
namespace {

// Two triangles on the same vertices, opposite ways, are what is left of a flap that rounding pressed flat:
// they enclose nothing, and without them their neighbours meet.
std::size_t drop_pressed_flaps(TriangleMesh& mesh) {
  const auto turned_to_lowest = [](std::array<int, 3> t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  };
  std::vector<std::pair<std::array<int, 3>, std::size_t>> all;
  all.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    all.emplace_back(turned_to_lowest(mesh.triangles[i]), i);
  std::sort(all.begin(), all.end());
  std::vector<char> gone(mesh.triangles.size(), 0);
  std::size_t count = 0;
  for (const auto& [triangle, i] : all) {
    const std::array<int, 3> reverse{triangle[0], triangle[2], triangle[1]};
    if (reverse < triangle) continue;
    auto place = std::lower_bound(all.begin(), all.end(), std::pair(reverse, std::size_t{0}));
    while (place != all.end() && place->first == reverse && gone[place->second]) ++place;
    if (gone[i] || place == all.end() || place->first != reverse) continue;
    gone[i] = gone[place->second] = 1;
    count += 2;
  }
  if (count == 0) return 0;
  std::size_t next = 0;
  for (std::size_t t = 0; t < gone.size(); ++t) {
    if (!gone[t]) mesh.triangles[next++] = mesh.triangles[t];
  }
  mesh.triangles.resize(next);
  return count;
}

Status check_closed(const TriangleMesh& mesh) {
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() == 2 && origin_of(mesh, h[0]) != origin_of(mesh, h[1])) continue;
    const Eigen::Vector3d& a = mesh.vertices[origin_of(mesh, h[0])];
    const Eigen::Vector3d& b = mesh.vertices[target_of(mesh, h[0])];
    return invalid_input(
        fmt::format("the surface is not closed: the edge from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, "
                    "{:.6g}) has {} triangle{}{}",
                    a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), h.size(), h.size() == 1 ? "" : "s",
                    h.size() == 2 ? " that look opposite ways" : ""));
  }
  return ok_status();
}

}  // namespace

Result<Solid> Solid::make(TriangleMesh mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (double& x : mesh.vertices[v]) {
      if (!(std::abs(x) <= std::numeric_limits<float>::max())) {
        return invalid_input(fmt::format("vertex {}: a coordinate is no finite float", v));
      }
      x = static_cast<float>(x) + 0.0;  // and -0 becomes +0
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v >= 0 && static_cast<std::size_t>(v) < mesh.vertices.size()) continue;
      return invalid_input(fmt::format("triangle {}: index {} of {} vertices", t, v, mesh.vertices.size()));
    }
  }
  weld(mesh, 0);
  drop_degenerate(mesh);
  while (drop_pressed_flaps(mesh) > 0) {
  }
  drop_unused_vertices(mesh);
  if (mesh.triangles.empty()) return invalid_input("the mesh encloses no volume: no triangle is left of it");
  if (Status s = check_closed(mesh); !s.ok()) return s.error();

  Solid solid;
  solid.volume_mm3_ = signed_volume(mesh);
  if (!(solid.volume_mm3_ > 0)) {
    return invalid_input(
        fmt::format("the mesh encloses no volume ({:.6g} mm3, seen from outside)", solid.volume_mm3_));
  }
  solid.area_mm2_ = surface_area(mesh);
  solid.box_ = bounding_box(mesh);
  solid.centroid_mm_ = volume_centroid(mesh);
  solid.mesh_ = std::move(mesh);
  return solid;
}

}  // namespace skinframe
