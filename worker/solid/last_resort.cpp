// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/last_resort.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "worker/solid/half_edges.h"
#include "worker/solid/level_set_union.h"
#include "worker/solid/wrap.h"

namespace skinframe {
namespace {

// Of the box's diagonal.
constexpr double kAlphaRelative = 1.0 / 150, kOffsetRelative = 1.0 / 3000;

// A wrap keeps a Delaunay mesh about all that it encloses, some kilobyte for each place of it, and a ring of
// places about each part however small. A body as large as its box has 70,000 places.
constexpr double kMostPlaces = 300'000, kPlacesAPart = 30;

// Boundary edges that hang together, whatever the senses and however many meet in a vertex.
struct Rim {
  std::vector<std::pair<int, int>> edges;
  double length = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // of its edges, by length
};

std::vector<Rim> find_rims(const TriangleMesh& mesh) {
  const EdgeTable edges(mesh);
  DisjointSets sets(mesh.vertices.size());
  std::vector<std::pair<int, int>> open;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() != 1) continue;
    open.emplace_back(origin_of(mesh, h[0]), target_of(mesh, h[0]));
    sets.join(open.back().first, open.back().second);
  }
  std::map<int, Rim> rims;
  for (const auto& [a, b] : open) {
    Rim& rim = rims[sets.find(a)];
    const double length = (mesh.vertices[b] - mesh.vertices[a]).norm();
    rim.edges.emplace_back(a, b);
    rim.length += length;
    rim.middle += length * (mesh.vertices[a] + mesh.vertices[b]) / 2;
  }
  std::vector<Rim> list;
  for (auto& [root, rim] : rims) {
    if (rim.length > 0) rim.middle /= rim.length;
    list.push_back(std::move(rim));
  }
  return list;
}

int count_parts(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    sets.join(a, b);
    sets.join(b, c);
  }
  std::vector<char> is_part(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles) is_part[sets.find(t[0])] = 1;
  return static_cast<int>(std::count(is_part.begin(), is_part.end(), 1));
}

// About how many places a wrap will have.
double places(const TriangleMesh& mesh, double alpha, int parts) {
  double sides = 0;  // of needles: their area is nothing
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const double longest = std::max({(p - q).norm(), (q - r).norm(), (r - p).norm()});
    if (longest > alpha) sides += longest / alpha;
  }
  return surface_area(mesh) / (alpha * alpha) + sides + kPlacesAPart * parts;
}

}  // namespace

Result<Wrapped> wrap_as_last_resort(TriangleMesh mesh, const std::string& defect,
                                    const LastResortOptions& options) {
  const std::vector<Rim> rims = find_rims(mesh);
  for (const Rim& rim : rims) {
    if (rim.length <= options.max_opening) continue;
    return invalid_input(fmt::format(
        "{}; and an opening of {} edges, {:.4g} mm around, near ({:.4g}, {:.4g}, {:.4g}) is too large to be "
        "closed here (only those up to {:.4g} mm are)",
        defect, rim.edges.size(), rim.length, rim.middle.x(), rim.middle.y(), rim.middle.z(),
        options.max_opening));
  }
  for (const Rim& rim : rims) {
    const int middle = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(rim.middle);
    for (const auto& [a, b] : rim.edges) mesh.triangles.push_back({b, a, middle});
  }
  const double diagonal = bounding_box(mesh).extent().norm();
  const double alpha = kAlphaRelative * diagonal, offset = kOffsetRelative * diagonal;
  const int parts = count_parts(mesh);
  if (places(mesh, alpha, parts) > kMostPlaces) {
    return invalid_input(fmt::format(
        "{}; and a surface of {} parts and {:.4g} mm2 is too much for a wrap around it: repair it where it "
        "comes from, or leave out what is not to be printed",
        defect, parts, surface_area(mesh)));
  }
  const double shut_off = shut_off_volume(mesh, level_set_voxel(surface_area(mesh), diagonal));
  auto wrapped = wrap_around(mesh, alpha, offset);
  if (!wrapped) return invalid_input(fmt::format("{}; and the surface could not be wrapped either", defect));
  const double volume = signed_volume(*wrapped);
  const double change = shut_off > 0 ? (volume - shut_off) / shut_off : 1;
  if (!(std::abs(change) <= options.max_volume_change_relative)) {
    return invalid_input(
        fmt::format("{}; and a wrap around it would have {:.6g} mm3 where the surface shuts off {:.6g} mm3: "
                    "more than {:g} % "
                    "of change",
                    defect, volume, shut_off, 100 * options.max_volume_change_relative));
  }
  return Wrapped{
      std::move(*wrapped),
      fmt::format("as a last resort, since {}: closed {} openings and wrapped the whole; detail narrower "
                  "than {:.2g} mm and cavities are filled, and {:.6g} mm3 become {:.6g} mm3 ({:+.2f} %)",
                  defect, rims.size(), 2 * alpha, shut_off, volume, 100 * change)};
}

}  // namespace skinframe
