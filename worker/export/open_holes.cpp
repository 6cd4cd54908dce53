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

// Of a hole in one sheet: as in CutSheet.
struct Rim {
  std::vector<int> loop;
  std::vector<double> angles;
};

// Earlier holes' numbers stay: vertices are only added.
struct Rims {
  Rim m, inner;
};

// Triangles from a loop on M to one on the cavity, both by their angles: seen from outside both turn
// counter-clockwise, and the strip looks at the axis. Where both have a corner of the prism at the same
// angle, no triangle reaches over it.
std::vector<std::array<int, 3>> wall_between(const Rim& m, const Rim& inner, int first_inner) {
  std::vector<std::array<int, 3>> wall;
  const std::size_t count_a = m.loop.size(), count_b = inner.loop.size();
  const auto a = [&](std::size_t i) { return m.loop[i % count_a]; };
  const auto b = [&](std::size_t j) { return first_inner + inner.loop[j % count_b]; };
  const auto angle = [](const Rim& rim, std::size_t i) {
    const std::size_t n = rim.loop.size();
    return rim.angles[i % n] + (i >= n ? 2.0 * std::numbers::pi : 0.0);
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

std::vector<std::array<int, 3>> walls_of(const std::vector<Rims>& rims, const Sheets& sheets) {
  std::vector<std::array<int, 3>> walls;
  for (const auto& [m, inner] : rims) {
    const auto wall = wall_between(m, inner, static_cast<int>(sheets.outer.vertices.size()));
    walls.insert(walls.end(), wall.begin(), wall.end());
  }
  return walls;
}

TriangleMesh joined(const Sheets& sheets, const std::vector<Rims>& rims) {
  TriangleMesh mesh = sheets.outer;
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), sheets.cavity.vertices.begin(), sheets.cavity.vertices.end());
  for (const auto& t : sheets.cavity.triangles)
    mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  const auto walls = walls_of(rims, sheets);
  mesh.triangles.insert(mesh.triangles.end(), walls.begin(), walls.end());
  return mesh;
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  Eigen::AlignedBox3d box(mesh.vertices[t[0]]);
  box.extend(mesh.vertices[t[1]]);
  box.extend(mesh.vertices[t[2]]);
  return box;
}

bool is_near(const Eigen::AlignedBox3d& box, const Opening& opening) {
  const double near = kNearInRadii * opening.radius_mm + opening.clear_mm;
  return box.squaredExteriorDistance(opening.centre_mm) < near * near;
}

std::size_t crossings_near(const TriangleMesh& mesh, const Opening& opening) {
  std::vector<int> near;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    if (is_near(box_of(mesh, mesh.triangles[t]), opening)) near.push_back(t);
  return crossing_triangles(mesh, near).size();
}

// What of a sheet has to do with a hole, in the sheet's order but with numbers of its own: a sheet has
// hundreds of thousands of triangles, this some thousands.
struct Part {
  TriangleMesh mesh;
  std::vector<int> triangles, vertices;  // their numbers in the sheet
  std::vector<int> numbers;              // of the sheet's vertices in the part; -1 where they are not in it
};

// All triangles near the opening, and all about the corners of those that the cut may touch and about earlier
// rims.
Part part_near(const TriangleMesh& sheet, const Opening& opening, const std::vector<Rims>& rims,
               const Rim Rims::*rim) {
  const Eigen::AlignedBox3d reach = reach_of_cut(opening);
  std::vector<char> taken(sheet.triangles.size(), 0), about(sheet.vertices.size(), 0);
  for (const Rims& earlier : rims)
    for (const int v : (earlier.*rim).loop) about[v] = 1;
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const Eigen::AlignedBox3d box = box_of(sheet, sheet.triangles[t]);
    taken[t] = is_near(box, opening);
    if (!reach.intersects(box)) continue;
    for (const int v : sheet.triangles[t]) about[v] = 1;
  }
  Part part;
  part.numbers.assign(sheet.vertices.size(), -1);
  const auto number_of = [&](int v) {
    if (part.numbers[v] < 0) {
      part.numbers[v] = static_cast<int>(part.vertices.size());
      part.vertices.push_back(v);
      part.mesh.vertices.push_back(sheet.vertices[v]);
    }
    return part.numbers[v];
  };
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const auto& [a, b, c] = sheet.triangles[t];
    if (!taken[t] && !about[a] && !about[b] && !about[c]) continue;
    part.mesh.triangles.push_back({number_of(a), number_of(b), number_of(c)});
    part.triangles.push_back(static_cast<int>(t));
  }
  return part;
}

Rim in_part(Rim rim, const Part& part) {
  for (int& v : rim.loop) v = part.numbers[v];
  return rim;
}

// The part's cut as one of the whole sheet.
CutSheet in_sheet(CutSheet cut, const Part& part, const TriangleMesh& sheet) {
  const auto known = static_cast<int>(part.vertices.size()), all = static_cast<int>(sheet.vertices.size());
  const auto rename = [&](int& v) { v = v < known ? part.vertices[v] : all + v - known; };
  for (int& t : cut.gone) t = part.triangles[t];
  for (auto* list : {&cut.around, &cut.lid})
    for (auto& triangle : *list) std::for_each(triangle.begin(), triangle.end(), rename);
  std::for_each(cut.loop.begin(), cut.loop.end(), rename);
  return cut;
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

struct Hole {
  CutSheet m, inner;
};

// Of the sheets about an opening, with earlier holes' rims; none where no cut leaves them whole.
std::optional<Hole> cut_hole(const Sheets& sheets, const std::vector<Rims>& rims, const Opening& opening) {
  const TriangleMesh uncut = joined(sheets, rims);
  const int bad_edges = count_bad_edges(uncut);  // where the sheets go on
  const std::size_t crossings = crossings_near(uncut, opening);
  for (int turn = 0; turn < kMostTurns; ++turn) {
    auto m = cut_sheet(sheets.outer, opening, turn * kTurnRadians);
    auto inner = m ? cut_sheet(sheets.cavity, opening, turn * kTurnRadians) : std::nullopt;
    if (!inner || !stands_apart(sheets.outer, *m) || !stands_apart(sheets.cavity, *inner)) continue;
    Sheets tried = sheets;
    remove_lid(tried.outer, *m);
    remove_lid(tried.cavity, *inner);
    std::vector<Rims> with = rims;
    with.push_back({{m->loop, m->angles}, {inner->loop, inner->angles}});
    const TriangleMesh mesh = joined(tried, with);
    if (count_bad_edges(mesh) <= bad_edges && crossings_near(mesh, opening) <= crossings)
      return Hole{std::move(*m), std::move(*inner)};
  }
  return std::nullopt;
}

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
  std::vector<std::array<int, 3>> lids;
  for (const Opening& opening : openings) {
    const Part outer = part_near(sheets.outer, opening, rims, &Rims::m),
               cavity = part_near(sheets.cavity, opening, rims, &Rims::inner);
    std::vector<Rims> earlier;
    for (const Rims& rim : rims) earlier.push_back({in_part(rim.m, outer), in_part(rim.inner, cavity)});
    const auto hole = cut_hole({outer.mesh, cavity.mesh}, earlier, opening);
    (hole ? result.openings : result.uncut).push_back(opening);
    if (!hole) continue;
    const CutSheet m = in_sheet(hole->m, outer, sheets.outer),
                   inner = in_sheet(hole->inner, cavity, sheets.cavity);
    remove_lid(sheets.outer, m);
    remove_lid(sheets.cavity, inner);
    rims.push_back({{m.loop, m.angles}, {inner.loop, inner.angles}});
    lids.insert(lids.end(), m.lid.begin(), m.lid.end());
  }
  result.outer_triangles = sheets.outer.triangles.size();
  result.lids = {sheets.outer.vertices, lids};
  drop_unused_vertices(result.lids);
  result.mesh = joined(sheets, rims);
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
