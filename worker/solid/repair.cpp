// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>

#include "worker/solid/fill_holes.h"
#include "worker/solid/half_edges.h"
#include "worker/solid/orient.h"
#include "worker/solid/self_intersections.h"
#include "worker/solid/shells.h"
#include "worker/solid/weld.h"

namespace skinframe {
namespace {

using Sentences = std::vector<std::string>;

// Of the cube on the box's diagonal: below it a shell is a sheet, not a body.
constexpr double kEmptyShellVolumeRelative = 1e-12;
// How far touching bodies step apart, of the diagonal: some ten floats at the edge of the box, far below any
// printer.
constexpr double kPartingGapRelative = 2e-6;

// A wider weld may collapse at most one in so many triangles.
constexpr std::size_t kMostEatenPart = 100;

std::string counted(std::size_t count, std::string_view noun, std::string_view plural) {
  return fmt::format("{} {}", count, count == 1 ? noun : plural);
}

Status check_input(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return invalid_input("the mesh holds no triangle");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite())
      return invalid_input(fmt::format("vertex {}: a coordinate is not finite", v));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v >= 0 && static_cast<std::size_t>(v) < mesh.vertices.size()) continue;
      return invalid_input(fmt::format("triangle {}: index {} of {} vertices", t, v, mesh.vertices.size()));
    }
  }
  return ok_status();
}

std::size_t count_open_edges(const TriangleMesh& mesh) {
  const EdgeTable edges(mesh);
  std::size_t open = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) open += edges.half_edges(e).size() % 2;
  return open;
}

// Welds with the smallest tolerance that closes the mesh or, where none does, leaves the fewest open edges.
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

Status fill_small_openings(TriangleMesh& mesh, const RepairOptions& options, double diagonal,
                           Sentences& repairs) {
  const std::vector<Opening> openings = find_openings(mesh);
  if (openings.empty()) return ok_status();
  const double limit = options.max_hole_relative * diagonal;
  std::size_t edges = 0;
  for (const Opening& o : openings) edges += o.loop.size();
  const Opening& longest =
      *std::max_element(openings.begin(), openings.end(),
                        [](const Opening& a, const Opening& b) { return a.length < b.length; });
  if (longest.length > limit) {
    return invalid_input(
        fmt::format("the surface is open: {}, {} boundary edges; the longest is {:.4g} mm around, near "
                    "({:.4g}, {:.4g}, {:.4g}), and "
                    "only those up to {:.4g} mm are filled; close it where the mesh was made",
                    counted(openings.size(), "opening", "openings"), edges, longest.length,
                    longest.middle.x(), longest.middle.y(), longest.middle.z(), limit));
  }
  fill_openings(mesh, openings);
  repairs.push_back(fmt::format("filled {} of {} edges, the longest {:.3g} mm around",
                                counted(openings.size(), "hole", "holes"), edges, longest.length));
  return ok_status();
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

Result<RepairOutcome> run_chain(TriangleMesh mesh, const RepairOptions& options, RunContext& context) {
  Sentences repairs, warnings;
  const double diagonal = bounding_box(mesh).extent().norm();
  if (!(diagonal > 0)) return invalid_input("the mesh has no extent: all its vertices coincide");

  weld_until_closed(mesh, options, diagonal, repairs);
  if (mesh.triangles.empty())
    return invalid_input("the mesh encloses no volume: every triangle is collapsed");
  remove_duplicates(mesh, repairs);
  if (context.cancelled()) return cancelled_error();

  const Result<std::size_t> turned = orient_patches(mesh);
  if (!turned.ok()) return turned.error();
  if (*turned > 0)
    repairs.push_back(fmt::format("turned {} round", counted(*turned, "triangle", "triangles")));
  const Result<PartCounts> parted = part_touching_edges(mesh, kPartingGapRelative * diagonal);
  if (!parted.ok()) return parted.error();
  if (parted->edges > 0) {
    repairs.push_back(fmt::format("parted the bodies that touch along {} by {:.2g} mm",
                                  counted(parted->edges, "edge", "edges"),
                                  2 * kPartingGapRelative * diagonal));
  }
  const std::size_t debris = drop_small_open_shells(mesh, options.max_debris_relative * diagonal);
  if (debris > 0)
    repairs.push_back(fmt::format("dropped {}", counted(debris, "loose scrap", "loose scraps")));
  if (context.cancelled()) return cancelled_error();

  if (Status s = fill_small_openings(mesh, options, diagonal, repairs); !s.ok()) return s.error();
  const std::size_t empty =
      drop_empty_shells(mesh, kEmptyShellVolumeRelative * diagonal * diagonal * diagonal);
  if (empty > 0) {
    repairs.push_back(
        fmt::format("dropped {} that enclose nothing", counted(empty, "closed sheet", "closed sheets")));
  }
  if (Status s = turn_outward(mesh, *turned == 0, repairs); !s.ok()) return s.error();
  if (context.cancelled()) return cancelled_error();

  Result<Solid> solid = Solid::make(std::move(mesh));
  if (!solid.ok()) return solid.error();
  if (options.count_self_intersections) {
    const std::size_t pairs = count_self_intersections(solid->mesh());
    if (pairs > 0) {
      warnings.push_back(
          fmt::format("{} of triangles cut each other; accepted as it is", counted(pairs, "pair", "pairs")));
    }
  }
  return RepairOutcome{std::move(solid).value(), std::move(repairs), std::move(warnings)};
}

}  // namespace

Status RepairOptions::validate() const {
  const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!within(weld_tolerance_relative, 0, 1e-2))
    return invalid_input("weld_tolerance_relative must be in [0, 0.01]");
  if (!within(max_weld_tolerance_relative, weld_tolerance_relative, 1e-2)) {
    return invalid_input("max_weld_tolerance_relative must be in [weld_tolerance_relative, 0.01]");
  }
  if (!within(max_hole_relative, 0, 1)) return invalid_input("max_hole_relative must be in [0, 1]");
  if (!within(max_debris_relative, 0, 0.1)) return invalid_input("max_debris_relative must be in [0, 0.1]");
  return ok_status();
}

Result<RepairOutcome> repair(TriangleMesh mesh, const RepairOptions& options, RunContext& context) {
  if (Status s = options.validate(); !s.ok()) return s.error();
  if (Status s = check_input(mesh); !s.ok()) return s.error();
  try {
    return run_chain(std::move(mesh), options, context);
  } catch (const std::bad_alloc&) {
    throw;  // the job ends OUT_OF_MEMORY, not INTERNAL
  } catch (const std::exception& e) {
    return internal_error(fmt::format("the mesh could not be repaired: {}", e.what()));
  }
}

}  // namespace skinframe
