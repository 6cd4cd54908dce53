// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/open_holes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "worker/drain/cut_sheet.h"
#include "worker/export/crossings.h"
#include "worker/frame/vertex_graph.h"
#include "worker/run/result.h"
#include "worker/skin/mend_edges.h"

namespace skinframe {
namespace {

constexpr double kNearInRadii = 1.5;  // of a hole: where crossings are looked for anew

struct Sheets {
  TriangleMesh outer, cavity;  // both outward: the cavity's towards the skin
};

// Triangles from a loop on M to one on the cavity, both by their angles: seen from outside both turn
// counter-clockwise, and the strip looks at the axis. Where both have a corner of the prism at the same
// angle, no triangle reaches over it.
std::vector<std::array<int, 3>> wall_between(const CutSheet& m, const CutSheet& inner, int first_inner) {
  std::vector<std::array<int, 3>> wall;
  const std::size_t count_a = m.loop.size(), count_b = inner.loop.size();
  const auto a = [&](std::size_t i) { return m.loop[i % count_a]; };
  const auto b = [&](std::size_t j) { return first_inner + inner.loop[j % count_b]; };
  const auto angle = [](const CutSheet& cut, std::size_t i) {
    const std::size_t n = cut.loop.size();
    return cut.angles[i % n] + (i >= n ? 2.0 * std::numbers::pi : 0.0);
  };
  std::size_t i = 0, j = 0;
  while (i < count_a || j < count_b) {
    const bool along_m = j == count_b || (i < count_a && angle(m, i + 1) <= angle(inner, j + 1));
    if (along_m) {
      wall.push_back({a(i), a(i + 1), b(j)});
      ++i;
    } else {
      wall.push_back({b(j + 1), b(j), a(i)});
      ++j;
    }
  }
  return wall;
}

TriangleMesh joined(const Sheets& sheets, const std::vector<std::array<int, 3>>& walls) {
  TriangleMesh mesh = sheets.outer;
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), sheets.cavity.vertices.begin(), sheets.cavity.vertices.end());
  for (const auto& t : sheets.cavity.triangles)
    mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  mesh.triangles.insert(mesh.triangles.end(), walls.begin(), walls.end());
  return mesh;
}

std::size_t crossings_near(const TriangleMesh& mesh, const Opening& opening) {
  std::vector<int> near;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3d low = mesh.vertices[a].cwiseMin(mesh.vertices[b]).cwiseMin(mesh.vertices[c]),
                          high = mesh.vertices[a].cwiseMax(mesh.vertices[b]).cwiseMax(mesh.vertices[c]);
    const Eigen::Vector3d nearest = opening.centre_mm.cwiseMax(low).cwiseMin(high);
    if ((nearest - opening.centre_mm).norm() < kNearInRadii * opening.radius_mm + opening.clear_mm)
      near.push_back(t);
  }
  return crossing_triangles(mesh, near).size();
}

// No corner of the cut falls on another one of the surface.
bool stands_apart(const TriangleMesh& mesh, const CutSheet& cut) {
  std::vector<std::array<double, 3>> added;
  for (const Eigen::Vector3d& p : cut.added) added.push_back({p.x(), p.y(), p.z()});
  std::sort(added.begin(), added.end());
  if (std::adjacent_find(added.begin(), added.end()) != added.end()) return false;
  return std::none_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Eigen::Vector3d& p) {
    return std::binary_search(added.begin(), added.end(), std::array<double, 3>{p.x(), p.y(), p.z()});
  });
}

// Loops of earlier holes keep their numbers: vertices are only added.
struct Rims {
  CutSheet m, inner;
};

}  // namespace

OpenedMesh open_holes(const TriangleMesh& merged, std::size_t outer_triangles,
                      const std::vector<Opening>& openings) {
  SKINFRAME_CHECK(outer_triangles <= merged.triangles.size());
  Sheets sheets;
  sheets.outer = {
      merged.vertices,
      {merged.triangles.begin(), merged.triangles.begin() + static_cast<std::ptrdiff_t>(outer_triangles)}};
  sheets.cavity.vertices = merged.vertices;
  for (std::size_t t = outer_triangles; t < merged.triangles.size(); ++t) {
    const auto& [a, b, c] = merged.triangles[t];
    sheets.cavity.triangles.push_back({a, c, b});
  }
  drop_unused_vertices(sheets.outer);
  drop_unused_vertices(sheets.cavity);

  OpenedMesh result;
  std::vector<Rims> rims;
  const auto walls_of = [](const std::vector<Rims>& all, const Sheets& both) {
    std::vector<std::array<int, 3>> walls;
    for (const Rims& rim : all) {
      const auto wall = wall_between(rim.m, rim.inner, static_cast<int>(both.outer.vertices.size()));
      walls.insert(walls.end(), wall.begin(), wall.end());
    }
    return walls;
  };
  std::vector<std::array<int, 3>> lids;
  for (const Opening& opening : openings) {
    const std::size_t before = crossings_near(joined(sheets, walls_of(rims, sheets)), opening);
    bool is_cut = false;
    for (int turn = 0; turn < kMostTurns && !is_cut; ++turn) {
      auto m = cut_sheet(sheets.outer, opening, turn * kTurnRadians);
      auto inner = m ? cut_sheet(sheets.cavity, opening, turn * kTurnRadians) : std::nullopt;
      if (!inner || !stands_apart(sheets.outer, *m) || !stands_apart(sheets.cavity, *inner)) continue;
      Sheets tried = sheets;
      remove_lid(tried.outer, *m);
      remove_lid(tried.cavity, *inner);
      std::vector<Rims> with = rims;
      with.push_back({*m, *inner});
      const TriangleMesh mesh = joined(tried, walls_of(with, tried));
      if (count_bad_edges(mesh) > 0 || crossings_near(mesh, opening) > before) continue;
      sheets = std::move(tried);
      rims = std::move(with);
      lids.insert(lids.end(), m->lid.begin(), m->lid.end());
      is_cut = true;
    }
    (is_cut ? result.openings : result.uncut).push_back(opening);
  }
  result.outer_triangles = sheets.outer.triangles.size();
  result.lids = {sheets.outer.vertices, lids};
  drop_unused_vertices(result.lids);
  result.mesh = joined(sheets, walls_of(rims, sheets));
  drop_unused_vertices(result.mesh);
  result.volume_mm3 = signed_volume(result.mesh);
  return result;
}

std::vector<SealedVoid> find_sealed_voids(const TriangleMesh& closed_mesh) {
  std::vector<SealedVoid> sealed;
  for (const TriangleMesh& shell : split_pieces(closed_mesh)) {
    const double volume = signed_volume(shell);
    if (volume < 0.0) sealed.push_back({-volume, volume_centroid(shell)});
  }
  std::stable_sort(sealed.begin(), sealed.end(),
                   [](const SealedVoid& a, const SealedVoid& b) { return a.volume_mm3 > b.volume_mm3; });
  return sealed;
}

TriangleMesh make_caps(const TriangleMesh& m, const std::vector<Opening>& openings, double thickness_mm,
                       double clearance_mm, int* capped) {
  TriangleMesh caps;
  *capped = 0;
  for (Opening opening : openings) {
    opening.radius_mm -= clearance_mm;
    std::optional<CutSheet> cut;
    for (int turn = 0; turn < kMostTurns && !cut; ++turn) cut = cut_sheet(m, opening, turn * kTurnRadians);
    if (!cut) continue;
    TriangleMesh top{m.vertices, cut->lid};
    top.vertices.insert(top.vertices.end(), cut->added.begin(), cut->added.end());
    top.triangles = cut->lid;
    // The rim's numbers after what is not used has gone.
    std::vector<int> number(top.vertices.size(), -1);
    TriangleMesh plug;
    const auto renamed = [&](int v) {
      if (number[v] < 0) {
        number[v] = static_cast<int>(plug.vertices.size());
        plug.vertices.push_back(top.vertices[v]);
      }
      return number[v];
    };
    for (const auto& [a, b, c] : top.triangles)
      plug.triangles.push_back({renamed(a), renamed(b), renamed(c)});
    const int below = static_cast<int>(plug.vertices.size());
    for (int v = 0; v < below; ++v)
      plug.vertices.push_back((plug.vertices[v] - thickness_mm * opening.axis).cast<float>().cast<double>());
    const std::size_t faces = plug.triangles.size();
    for (std::size_t t = 0; t < faces; ++t) {
      const auto [a, b, c] = plug.triangles[t];
      plug.triangles.push_back({below + a, below + c, below + b});
    }
    for (std::size_t i = 0; i < cut->loop.size(); ++i) {
      const int a = number[cut->loop[i]], b = number[cut->loop[(i + 1) % cut->loop.size()]];
      plug.triangles.push_back({b, a, below + a});
      plug.triangles.push_back({b, below + a, below + b});
    }
    if (count_bad_edges(plug) > 0) continue;
    const int first = static_cast<int>(caps.vertices.size());
    caps.vertices.insert(caps.vertices.end(), plug.vertices.begin(), plug.vertices.end());
    for (const auto& t : plug.triangles) caps.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    ++*capped;
  }
  return caps;
}

}  // namespace skinframe
