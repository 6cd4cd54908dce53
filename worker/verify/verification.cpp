// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

using Figure = std::optional<double>;

Winner winner_of(Figure ours, Figure hollow, bool more_is_better) {
  if (!ours || !hollow) return Winner::kNeither;
  if (std::abs(*ours - *hollow) <= kEvenShare * std::max(std::abs(*ours), std::abs(*hollow)))
    return Winner::kNeither;
  return (*ours < *hollow) != more_is_better ? Winner::kSkinFrame : Winner::kHollow;
}

}  // namespace

double mesh_error_of(const std::vector<std::vector<double>>& works, const std::vector<double>& least_work) {
  const std::vector<double>&last = works[works.size() - 1], &coarser = works[works.size() - 2];
  double worst = 0;
  for (std::size_t c = 0; c < last.size(); ++c) {
    const double change = last[c] - coarser[c];
    double ratio = 2;
    if (works.size() > 2 && change != 0)
      ratio = std::clamp((coarser[c] - works[works.size() - 3][c]) / change, 2.0, 4.0);
    worst =
        std::max(worst, std::abs(change) / (ratio - 1) / std::max({std::abs(last[c]), least_work[c], 1e-30}));
  }
  return worst;
}

std::string mesh_words(const Verification& v) {
  if (v.mesh_error <= kMeshTolerance)
    return fmt::format("the loads' work is known to {:.2g} %", 100 * v.mesh_error);
  return fmt::format(
      "the loads' work is known to {:.2g} % only, not to the {:g} % aimed at: the frame's triangles are "
      "coarse "
      "against the body, and {} nodes of the fine mesh do not make up for it",
      100 * v.mesh_error, 100 * kMeshTolerance, v.nodes);
}

PinchFigures figures_of_sites(std::vector<PinchedSite> sites) {
  PinchFigures out;
  out.sites = std::move(sites);
  for (std::size_t i = 0; i < out.sites.size(); ++i) {
    const double closing = out.sites[i].closing_mm;
    out.mean_mm += closing / static_cast<double>(out.sites.size());
    if (closing <= out.max_mm) continue;
    out.max_mm = closing;
    out.worst = static_cast<int>(i);
  }
  return out;
}

double DesignFigures::max_displacement_mm() const {
  double worst = 0;
  for (const LoadFigures& load : loads) worst = std::max(worst, load.max_displacement_mm);
  return worst;
}

double DesignFigures::max_stress_mpa() const {
  double worst = 0;
  for (const LoadFigures& load : loads)
    worst = std::max({worst, load.skin_stress_mpa, load.strut_stress_mpa});
  return worst;
}

std::optional<double> DesignFigures::buckling_factor() const {
  std::optional<double> least;
  for (const LoadFigures& load : loads)
    if (load.buckling_factor) least = std::min(least.value_or(*load.buckling_factor), *load.buckling_factor);
  return least;
}

const char* to_string(Winner winner) {
  switch (winner) {
    case Winner::kSkinFrame:
      return "skin-frame";
    case Winner::kHollow:
      return "hollow";
    case Winner::kNeither:
      return "even";
  }
  return "even";
}

std::vector<ComparedRow> compare(const Verification& v) {
  std::vector<ComparedRow> rows;
  const std::optional<DesignFigures> ours = v.ours;
  const auto add = [&](const std::string& name, bool more_is_better, auto read) {
    const auto figure = [&](const std::optional<DesignFigures>& design) -> Figure {
      return design ? Figure(read(*design)) : std::nullopt;
    };
    ComparedRow row{
        name, figure(ours), figure(v.hollow), figure(v.solid), figure(v.skin_alone), Winner::kNeither};
    row.winner = winner_of(row.ours, row.hollow, more_is_better);
    rows.push_back(row);
  };
  add("max_displacement_mm", false, [](const DesignFigures& d) { return Figure(d.max_displacement_mm()); });
  add("pinch_mean_mm", false,
      [](const DesignFigures& d) { return d.pinch ? Figure(d.pinch->mean_mm) : std::nullopt; });
  add("pinch_max_mm", false,
      [](const DesignFigures& d) { return d.pinch ? Figure(d.pinch->max_mm) : std::nullopt; });
  add("buckling_factor", true, [](const DesignFigures& d) { return d.buckling_factor(); });
  return rows;
}

std::string verdict_of(const Verification& v) {
  if (!v.hollow) return "not compared with a hollow of equal mass: " + v.hollow_missing;
  int ours = 0, hollow = 0;
  std::string won, lost;
  for (const ComparedRow& row : compare(v)) {
    if (row.winner == Winner::kSkinFrame) won += (ours++ ? ", " : "") + row.name;
    if (row.winner == Winner::kHollow) lost += (hollow++ ? ", " : "") + row.name;
  }
  const std::string wall =
      fmt::format("a uniform hollow of {:.2f} mm wall and the same mass", v.hollow_wall_mm);
  if (ours == 0 && hollow > 0)
    return fmt::format("{} is better in {} and worse in nothing compared here: it would do", wall, lost);
  if (ours == 0) return fmt::format("{} does as well in everything compared here", wall);
  if (hollow == 0) return fmt::format("better than {} in {}, worse in nothing compared here", wall, won);
  return fmt::format("better than {} in {}; worse in {}", wall, won, lost);
}

}  // namespace skinframe
