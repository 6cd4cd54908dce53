// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/restore_struts.h"

#include <algorithm>
#include <numeric>

#include "worker/optimize/size_frame.h"

namespace skinframe {
namespace {

// Shares of the removed struts that come back, try after try.
constexpr double kRestored[] = {0.0, 0.1, 0.3};
// A strut with lower bound zero is removed at this share of the mean area.
constexpr double kVanishedShare = 1e-4;

// Bounds know the clearance of nodes where they first stood. Once geometry has moved them, a strut that grows
// may leave what the caller accepts.
bool loses_acceptance(const Design& before, const Design& after, const OptimizeOptions& options) {
  const auto& accepts = options.accepts;
  return accepts && !accepts(after.problem.frame, radii_of(after.areas_mm2)) &&
         accepts(before.problem.frame, radii_of(before.areas_mm2));
}

}  // namespace

double mean_area_mm2(const std::vector<double>& areas_mm2) {
  return std::accumulate(areas_mm2.begin(), areas_mm2.end(), 0.0) / static_cast<double>(areas_mm2.size());
}

bool size_again(Design& design, const std::vector<double>& hint_mm2, std::optional<double> most_mm3,
                Session& session) {
  session.offer(design.warm);
  session.give_up_above(most_mm3);
  SizedFrame sized = size_frame(design.problem, hint_mm2, session);
  session.offer({});
  session.give_up_above({});
  if (!sized.feasible() || (most_mm3 && sized.volume_mm3() > *most_mm3)) return false;
  take_sizing(design, std::move(sized));
  design.warm = session.latest();
  return true;
}

std::optional<Design> without_thin_struts(const Design& design, const std::vector<double>& areas_mm2,
                                          double removal_share, Session& session) {
  const std::vector<bool> removable = removable_struts(design.problem);
  const double vanished = kVanishedShare * mean_area_mm2(design.areas_mm2);
  std::vector<bool> keep(removable.size(), true);
  std::vector<int> removed;
  for (int j = 0; j < static_cast<int>(removable.size()); ++j) {
    const double lower = area_bounds(design.problem, j).lower_mm2;
    if (!removable[j] || areas_mm2[j] > std::max(removal_share * lower, vanished)) continue;
    keep[j] = false;
    removed.push_back(j);
  }
  if (removed.empty()) return std::nullopt;
  std::stable_sort(removed.begin(), removed.end(), [&](int a, int b) { return areas_mm2[a] > areas_mm2[b]; });

  std::size_t tried = 0;  // struts of the try before
  for (double restored : kRestored) {
    const auto back = static_cast<std::size_t>(restored * static_cast<double>(removed.size()));
    for (std::size_t r = 0; r < back; ++r) keep[removed[r]] = true;
    Design from = design;
    from.areas_mm2 = areas_mm2;
    Design fewer = reduced_design(from, keep);
    const std::size_t struts = fewer.problem.frame.struts.size();
    if (struts == 0 || struts == tried) continue;
    if (struts == design.areas_mm2.size()) break;
    tried = struts;
    const std::vector<double> hint = fewer.areas_mm2;
    const bool smaller = size_again(fewer, hint, (1 + kVolumeTie) * design.volume_mm3, session);
    if (session.cancelled()) return std::nullopt;
    if (smaller && !loses_acceptance(design, fewer, session.options())) return fewer;
  }
  return std::nullopt;
}

}  // namespace skinframe
