// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/repair_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "worker/solid/fill_holes.h"
#include "worker/solid/half_edges.h"
#include "worker/solid/orient.h"
#include "worker/solid/sheets.h"
#include "worker/solid/shells.h"
#include "worker/solid/stitch.h"
#include "worker/solid/weld.h"

namespace skinframe {
namespace {

// Of the cube on the box's diagonal: below it a shell is a sheet, not a body.
constexpr double kEmptyShellVolumeRelative = 1e-12;
// How far touching bodies step apart, of the diagonal: some ten floats at the edge of the box, far below any
// printer.
constexpr double kPartingGapRelative = 2e-6;

// A vertex that far from an edge lies on it. Of the diagonal.
constexpr double kStitchRelative = 1e-5;

// A wider weld may collapse at most one in so many triangles.
constexpr std::size_t kMostEatenPart = 100;

std::string counted(std::size_t count, std::string_view noun, std::string_view plural) {
  return fmt::format("{} {}", count, count == 1 ? noun : plural);
}

std::size_t count_open_edges(const TriangleMesh& mesh) {
  const EdgeTable edges(mesh);
  std::size_t open = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) open += edges.half_edges(e).size() % 2;
  return open;
}

Status fill_small_openings(TriangleMesh& mesh, const RepairOptions& options, double diagonal,
                           Sentences& repairs) {
  const std::vector<Opening> openings = find_openings(mesh);
  if (openings.empty()) return ok_status();
  const double limit = options.max_hole_relative * diagonal;
  const double cut_limit = options.max_flat_cut_relative * diagonal;
  std::size_t edges = 0;
  for (const Opening& o : openings) edges += o.loop.size();
  const Opening& longest =
      *std::max_element(openings.begin(), openings.end(),
                        [](const Opening& a, const Opening& b) { return a.length < b.length; });
  const bool too_large = std::any_of(openings.begin(), openings.end(), [&](const Opening& o) {
    return o.length > limit && (o.length > cut_limit || !is_flat_cut(mesh, o));
  });
  if (too_large) {
    return invalid_input(fmt::format(
        "the surface is open: {}, {} boundary edges; the longest is {:.4g} mm around, near "
        "({:.4g}, {:.4g}, {:.4g}), and only those up to {:.4g} mm and flat cuts through the whole "
        "body are closed; close it where the mesh was made",
        counted(openings.size(), "opening", "openings"), edges, longest.length, longest.middle.x(),
        longest.middle.y(), longest.middle.z(), limit, cut_limit));
  }
  for (const Opening& o : openings) {
    if (o.length <= limit) continue;
    repairs.push_back(fmt::format(
        "capped the flat cut of {} edges, {:.4g} mm around, near ({:.4g}, {:.4g}, {:.4g}), "
        "with {:.4g} mm2 of new surface",
        o.loop.size(), o.length, o.middle.x(), o.middle.y(), o.middle.z(), opening_area(mesh, o)));
  }
  fill_openings(mesh, openings);
  repairs.push_back(fmt::format("filled {} of {} edges, the longest {:.3g} mm around",
                                counted(openings.size(), "hole", "holes"), edges, longest.length));
  return ok_status();
}

void drop_thin_air(TriangleMesh& mesh, Sentences& repairs) {
  const SheetCounts counts = drop_sheets(mesh);
  if (counts.fins > 0) {
    repairs.push_back(fmt::format("dropped {} without thickness that stood out of the body",
                                  counted(counts.fins, "triangle of a fin", "triangles of fins")));
  }
  if (counts.walls > 0) {
    repairs.push_back(fmt::format("dropped {} without thickness within the body",
                                  counted(counts.walls, "triangle of a wall", "triangles of walls")));
  }
}

Status turn_outward(TriangleMesh& mesh, bool trust_file_senses, Sentences& repairs) {
  const Result<NestingCounts> nesting = nest_shells(mesh, trust_file_senses);
  if (!nesting.ok()) return nesting.error();
  const NestingCounts& counts = *nesting;
  if (counts.turned > 0) {
    repairs.push_back(fmt::format("turned {} inside out", counted(counts.turned, "shell", "shells")));
  }
  if (counts.swallowed > 0) {
    repairs.push_back(fmt::format("dropped {} within the material of another",
                                  counted(counts.swallowed, "shell", "shells")));
  }
  return ok_status();
}

}  // namespace

void weld_until_closed(TriangleMesh& mesh, const RepairOptions& options, double diagonal,
                       Sentences& repairs) {
  TriangleMesh best;
  std::size_t best_open = 0, best_joined = 0;
  double best_tolerance = -1;
  for (double relative = options.weld_tolerance_relative;
       relative <= options.max_weld_tolerance_relative * 1.0001; relative *= 10) {
    TriangleMesh attempt = mesh;
    const std::size_t joined = weld(attempt, relative * diagonal);
    drop_degenerate(attempt);
    const std::size_t open = count_open_edges(attempt);
    // A tolerance near the size of the triangles shortens an opening by eating its rim: that mends nothing.
    const bool eats =
        attempt.triangles.size() + best.triangles.size() / kMostEatenPart < best.triangles.size();
    if (best_tolerance < 0 || (open < best_open && !eats)) {
      best = std::move(attempt);
      best_open = open;
      best_joined = joined;
      best_tolerance = relative * diagonal;
    }
    if (best_open == 0 || relative == 0) break;
  }
  const std::size_t dropped = mesh.triangles.size() - best.triangles.size();
  mesh = std::move(best);
  if (best_joined > 0) {
    repairs.push_back(fmt::format("joined {} within {:.3g} mm", counted(best_joined, "vertex", "vertices"),
                                  best_tolerance));
  }
  if (dropped > 0) {
    repairs.push_back(
        fmt::format("dropped {}", counted(dropped, "collapsed triangle", "collapsed triangles")));
  }
}

void stitch(TriangleMesh& mesh, double diagonal, Sentences& repairs) {
  const std::size_t count = split_at_touching_vertices(mesh, kStitchRelative * diagonal);
  if (count > 0) {
    repairs.push_back(
        fmt::format("joined {} to the edges that they lie on", counted(count, "vertex", "vertices")));
  }
}

void remove_duplicates(TriangleMesh& mesh, Sentences& repairs) {
  const DuplicateCounts counts = drop_duplicates(mesh);
  if (counts.repeated > 0) {
    repairs.push_back(
        fmt::format("dropped {}", counted(counts.repeated, "repeated triangle", "repeated triangles")));
  }
  if (counts.walls > 0) {
    repairs.push_back(
        fmt::format("dropped {} drawn double",
                    counted(counts.walls, "triangle of an inner wall", "triangles of inner walls")));
  }
}

Status straighten(TriangleMesh& mesh, double diagonal, bool& senses_kept, Sentences& repairs) {
  drop_thin_air(mesh, repairs);
  const Result<std::size_t> turned = orient_patches(mesh);
  if (!turned.ok()) return turned.error();
  senses_kept = *turned == 0;
  if (*turned > 0)
    repairs.push_back(fmt::format("turned {} round", counted(*turned, "triangle", "triangles")));
  const Result<PartCounts> parted = part_touching_edges(mesh, kPartingGapRelative * diagonal);
  if (!parted.ok()) return parted.error();
  if (parted->edges > 0) {
    repairs.push_back(fmt::format("parted the bodies that touch along {} by {:.2g} mm",
                                  counted(parted->edges, "edge", "edges"),
                                  2 * kPartingGapRelative * diagonal));
  }
  return ok_status();
}

Result<Solid> close(TriangleMesh mesh, const RepairOptions& options, double diagonal, bool senses_kept,
                    bool& large_opening, Sentences& repairs) {
  const std::size_t debris = drop_small_open_shells(mesh, options.max_debris_relative * diagonal);
  if (debris > 0)
    repairs.push_back(fmt::format("dropped {}", counted(debris, "loose scrap", "loose scraps")));
  if (Status s = fill_small_openings(mesh, options, diagonal, repairs); !s.ok()) {
    large_opening = true;
    return s.error();
  }
  const std::size_t empty =
      drop_empty_shells(mesh, kEmptyShellVolumeRelative * diagonal * diagonal * diagonal);
  if (empty > 0) {
    repairs.push_back(
        fmt::format("dropped {} that enclose nothing", counted(empty, "closed sheet", "closed sheets")));
  }
  if (Status s = turn_outward(mesh, senses_kept, repairs); !s.ok()) return s.error();
  return Solid::make(std::move(mesh));
}

}  // namespace skinframe
