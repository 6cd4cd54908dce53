// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/drain/cut_sheet.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <numbers>

namespace skinframe {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;
using Face = Mesh::Face_index;

constexpr double kSurelyWithin = 0.995;  // of the radius; the prism's sides are at 0.9988 of it and more
constexpr double kTie = 1e-7;            // radians: corners of the prism on both of its ends

Kernel::Point_3 to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
Eigen::Vector3d to_vector(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

Mesh prism_of(const Opening& opening, double turn) {
  const Across to = across(opening);
  Mesh mesh;
  std::vector<Vertex> inner, outer;
  for (int i = 0; i < kPrismSides; ++i) {
    const double angle = turn + 2.0 * std::numbers::pi * i / kPrismSides;
    const Eigen::Vector3d at =
        opening.centre_mm + opening.radius_mm * (std::cos(angle) * to.u + std::sin(angle) * to.v);
    inner.push_back(mesh.add_vertex(to_point(at - opening.clear_mm * opening.axis)));
    outer.push_back(mesh.add_vertex(to_point(at + opening.rise_mm * opening.axis)));
  }
  for (int i = 0; i < kPrismSides; ++i) {
    const int k = (i + 1) % kPrismSides;
    mesh.add_face(inner[i], inner[k], outer[k]);
    mesh.add_face(inner[i], outer[k], outer[i]);
    if (i == 0 || k == 0) continue;
    mesh.add_face(inner[0], inner[k], inner[i]);
    mesh.add_face(outer[0], outer[i], outer[k]);
  }
  return mesh;
}

std::vector<int> triangles_near(const TriangleMesh& mesh, const Opening& opening) {
  const Eigen::AlignedBox3d box = reach_of_cut(opening);
  std::vector<int> near;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    Eigen::AlignedBox3d own;
    for (const int v : mesh.triangles[t]) own.extend(mesh.vertices[v]);
    if (box.intersects(own)) near.push_back(t);
  }
  return near;
}

struct Patch {
  Mesh mesh;
  std::vector<int> origin;  // of each vertex, in the whole mesh
};

// None where the triangles are no surface (edges or corners that several sheets share).
std::optional<Patch> patch_of(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  Patch patch;
  std::map<int, Vertex> number;
  for (const int t : triangles) {
    std::array<Vertex, 3> corners;
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles[t][k];
      const auto [it, fresh] = number.try_emplace(v);
      if (fresh) {
        it->second = patch.mesh.add_vertex(to_point(mesh.vertices[v]));
        patch.origin.push_back(v);
      }
      corners[k] = it->second;
    }
    if (patch.mesh.add_face(corners[0], corners[1], corners[2]) == Mesh::null_face()) return std::nullopt;
  }
  return patch;
}

// The faces that hang together with those about the axis, up to edges of the cut; none where they reach the
// patch's end.
std::optional<std::vector<char>> faces_within(const Mesh& mesh, const Opening& opening,
                                              const Mesh::Property_map<Mesh::Edge_index, bool>& is_cut) {
  std::vector<char> within(mesh.num_faces(), 0);
  std::vector<Face> open;
  const Across to = across(opening);
  for (const Face f : mesh.faces()) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
      middle += (to_vector(mesh.point(v)) - opening.centre_mm) / 3.0;
    // A face of the cut patch is within or without as its middle is.
    const double along = middle.dot(opening.axis);
    const double beside = Eigen::Vector2d(middle.dot(to.u), middle.dot(to.v)).norm();
    if (beside < kSurelyWithin * opening.radius_mm && along < opening.rise_mm && along > -opening.clear_mm) {
      within[f] = 1;
      open.push_back(f);
    }
  }
  while (!open.empty()) {
    const Face f = open.back();
    open.pop_back();
    for (const auto h : mesh.halfedges_around_face(mesh.halfedge(f))) {
      if (is_cut[mesh.edge(h)]) continue;
      const Face next = mesh.face(mesh.opposite(h));
      if (next == Mesh::null_face()) return std::nullopt;
      if (within[next]) continue;
      within[next] = 1;
      open.push_back(next);
    }
  }
  return within;
}

// One loop of halfedges about the faces within; none where there are several or where it touches itself.
std::optional<std::vector<int>> rim_of(const Mesh& mesh, const std::vector<char>& within) {
  std::map<int, int> next;
  for (const Face f : mesh.faces()) {
    if (!within[f]) continue;
    for (const auto h : mesh.halfedges_around_face(mesh.halfedge(f))) {
      const Face other = mesh.face(mesh.opposite(h));
      if (other == Mesh::null_face()) return std::nullopt;
      if (within[other]) continue;
      if (!next.emplace(static_cast<int>(mesh.source(h)), static_cast<int>(mesh.target(h))).second)
        return std::nullopt;
    }
  }
  if (next.size() < 3) return std::nullopt;
  std::vector<int> loop{next.begin()->first};
  for (int v = next.begin()->second; v != loop.front(); v = next.at(v)) {
    loop.push_back(v);
    if (loop.size() > next.size()) return std::nullopt;
  }
  if (loop.size() != next.size()) return std::nullopt;
  return loop;
}

// Discs have V - E + F = 1.
bool is_disc(const Mesh& mesh, const std::vector<char>& within, std::size_t rim) {
  std::vector<char> seen(mesh.num_vertices(), 0);
  long faces = 0, vertices = 0;
  for (const Face f : mesh.faces()) {
    if (!within[f]) continue;
    ++faces;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
      vertices += !seen[v];
      seen[v] = 1;
    }
  }
  const long edges = (3 * faces + static_cast<long>(rim)) / 2;
  return vertices - edges + faces == 1;
}

// The loop turned to start at the least angle from `from` on; false where angles do not ascend.
bool sort_by_angle(const Opening& opening, double from, const std::vector<Eigen::Vector3d>& points,
                   std::vector<int>& loop, std::vector<double>& angles) {
  const Across to = across(opening);
  angles.clear();
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d d = p - opening.centre_mm;
    double angle = std::fmod(std::atan2(d.dot(to.v), d.dot(to.u)) - from, 2.0 * std::numbers::pi);
    if (angle < 0.0) angle += 2.0 * std::numbers::pi;
    angles.push_back(angle);
  }
  const auto first = std::min_element(angles.begin(), angles.end()) - angles.begin();
  std::rotate(angles.begin(), angles.begin() + first, angles.end());
  std::rotate(loop.begin(), loop.begin() + first, loop.end());
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (angles[i] <= angles[i - 1] + kTie) return false;
  return true;
}

std::optional<CutSheet> cut(const TriangleMesh& mesh, const Opening& opening, double turn) {
  const std::vector<int> near = triangles_near(mesh, opening);
  auto patch = patch_of(mesh, near);
  if (!patch) return std::nullopt;
  Mesh& sheet = patch->mesh;
  Mesh prism = prism_of(opening, turn);
  auto is_cut = sheet.add_property_map<Mesh::Edge_index, bool>("e:cut", false).first;
  pmp::corefine(sheet, prism,
                CGAL::parameters::edge_is_constrained_map(is_cut).throw_on_self_intersection(true),
                CGAL::parameters::all_default());
  const auto within = faces_within(sheet, opening, is_cut);
  if (!within) return std::nullopt;
  auto rim = rim_of(sheet, *within);
  if (!rim || !is_disc(sheet, *within, rim->size())) return std::nullopt;

  CutSheet result;
  result.gone = near;
  std::vector<int> number = patch->origin;
  for (std::size_t v = number.size(); v < sheet.num_vertices(); ++v) {
    number.push_back(static_cast<int>(mesh.vertices.size() + result.added.size()));
    result.added.push_back(
        to_vector(sheet.point(Vertex(static_cast<unsigned>(v)))).cast<float>().cast<double>());
  }
  const auto place = [&](int v) -> const Eigen::Vector3d& {
    const auto known = static_cast<int>(mesh.vertices.size());
    return v < known ? mesh.vertices[v] : result.added[v - known];
  };
  for (const Face f : sheet.faces()) {
    std::array<int, 3> corners{};
    int k = 0;
    for (const auto v : sheet.vertices_around_face(sheet.halfedge(f))) corners[k++] = number[v];
    const Eigen::Vector3d &a = place(corners[0]), &b = place(corners[1]), &c = place(corners[2]);
    if (a == b || b == c || c == a) return std::nullopt;
    if ((*within)[f] && (b - a).cross(c - a).dot(opening.axis) <= 0.0) return std::nullopt;
    ((*within)[f] ? result.lid : result.around).push_back(corners);
  }
  std::vector<Eigen::Vector3d> points;
  for (int& v : *rim) {
    v = number[v];
    points.push_back(place(v));
    // All of the cut is at the prism's sides: a sheet through its ends is none.
    if (distance_mm(opening, points.back()) > 1e-3 * opening.radius_mm) return std::nullopt;
  }
  result.loop = std::move(*rim);
  // From the middle of a side, so that no corner stands at the seam.
  const double from = turn + std::numbers::pi / kPrismSides;
  if (!sort_by_angle(opening, from, points, result.loop, result.angles)) return std::nullopt;
  for (const Eigen::Vector3d& p : points) {
    const double along = (p - opening.centre_mm).dot(opening.axis);
    if (along >= opening.rise_mm || along <= -opening.clear_mm) return std::nullopt;
  }
  return result;
}

}  // namespace

Eigen::AlignedBox3d reach_of_cut(const Opening& opening) {
  const Eigen::Vector3d a = opening.centre_mm - opening.clear_mm * opening.axis,
                        b = opening.centre_mm + opening.rise_mm * opening.axis;
  const Eigen::Vector3d beside = Eigen::Vector3d::Constant(1.01 * opening.radius_mm);
  return {a.cwiseMin(b) - beside, a.cwiseMax(b) + beside};
}

std::optional<CutSheet> cut_sheet(const TriangleMesh& mesh, const Opening& opening, double turn) {
  try {
    return cut(mesh, opening, turn);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // CGAL: the sheet cuts itself at the prism, or stands along a side of it
    return std::nullopt;
  }
}

void remove_lid(TriangleMesh& mesh, const CutSheet& cut) {
  mesh.vertices.insert(mesh.vertices.end(), cut.added.begin(), cut.added.end());
  std::size_t kept = 0, gone = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (gone < cut.gone.size() && static_cast<std::size_t>(cut.gone[gone]) == t) {
      ++gone;
      continue;
    }
    mesh.triangles[kept++] = mesh.triangles[t];
  }
  mesh.triangles.resize(kept);
  mesh.triangles.insert(mesh.triangles.end(), cut.around.begin(), cut.around.end());
}

}  // namespace skinframe
