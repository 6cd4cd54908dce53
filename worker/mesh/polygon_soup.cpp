// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/polygon_soup.h"

#include <fmt/format.h>

#include "worker/mesh/triangulate_polygon.h"

namespace skinframe {

std::string face_name(const PolygonSoup& soup, std::size_t face) {
  const std::uint64_t line = soup.faces[face].line;
  return line > 0 ? fmt::format("line {}", line) : fmt::format("face {}", face);
}

Status check_count(std::uint64_t count, std::uint64_t limit, std::string_view what) {
  if (count <= limit) return ok_status();
  return invalid_input(
      fmt::format("{} {} are more than the limit of {}; simplify the mesh", count, what, limit));
}

namespace {

// Those of the vertices that drop_unused_vertices() keeps, in its order.
std::vector<std::array<std::uint8_t, 3>> colours_of_used(std::vector<std::array<std::uint8_t, 3>> colours,
                                                         const TriangleMesh& mesh) {
  std::vector<bool> used(colours.size(), false);
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) used[v] = true;
  std::size_t kept = 0;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) colours[kept++] = colours[v];
  colours.resize(kept);
  return colours;
}

}  // namespace

Result<MeshFile> finish(PolygonSoup soup, std::string format, int index_base, const ReadRequest& request) {
  const auto vertex_count = static_cast<std::int64_t>(soup.vertices.size());
  // Fans and ears alike give corners - 2 triangles a face.
  std::uint64_t triangle_count = 0;
  for (const auto& face : soup.faces) triangle_count += face.count > 2 ? face.count - 2 : 0;
  if (triangle_count == 0) {
    return invalid_input(fmt::format("the {} file holds no triangle ({} vertices, {} faces)", format,
                                     vertex_count, soup.faces.size()));
  }
  if (Status s = check_count(triangle_count, request.limits.max_triangles, "triangles"); !s.ok())
    return s.error();

  MeshFile file;
  file.format = std::move(format);
  file.mesh.triangles.reserve(triangle_count);
  std::size_t polygons = 0, guessed = 0, too_few = 0;
  std::uint64_t steps_left = request.limits.max_cutting_steps;
  std::vector<int> corners;
  for (std::size_t f = 0; f < soup.faces.size(); ++f) {
    if (f % 65536 == 0 && request.context.cancelled()) return cancelled_error();
    const PolygonSoup::Face& face = soup.faces[f];
    corners.clear();
    for (std::uint64_t c = face.first; c < face.first + face.count; ++c) {
      const std::int64_t v = soup.corners[c];
      if (v < 0 || v >= vertex_count) {
        return invalid_input(fmt::format("{}: index {} of {} vertices{}", face_name(soup, f), v + index_base,
                                         vertex_count, index_base == 0 ? " (counted from 0)" : ""));
      }
      corners.push_back(static_cast<int>(v));
    }
    if (face.count < 3) ++too_few;
    if (face.count > 3) ++polygons;
    switch (triangulate_polygon(corners, soup.vertices, file.mesh.triangles, &steps_left)) {
      case Triangulation::kClean:
        break;
      case Triangulation::kGuessed:
        ++guessed;
        break;
      case Triangulation::kTooLong:
        return invalid_input(fmt::format(
            "{}: the outlines of the faces up to here, this one of {} corners, take too long to cut "
            "into triangles; triangulate the mesh where it is exported",
            face_name(soup, f), face.count));
    }
  }
  file.mesh.vertices = std::move(soup.vertices);
  if (!soup.colours.empty()) file.vertex_colours = colours_of_used(std::move(soup.colours), file.mesh);
  const std::size_t unused = drop_unused_vertices(file.mesh);
  if (polygons > 0) file.notes.push_back(fmt::format("cut {} polygons into triangles", polygons));
  if (guessed > 0) {
    file.notes.push_back(
        fmt::format("fanned {} polygons whose outline crosses itself or has no area", guessed));
  }
  if (too_few > 0) file.notes.push_back(fmt::format("dropped {} faces of fewer than 3 corners", too_few));
  if (unused > 0) file.notes.push_back(fmt::format("dropped {} vertices that no triangle uses", unused));
  return file;
}

}  // namespace skinframe
