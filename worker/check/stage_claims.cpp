// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

constexpr double kWritten = 1e-8;  // relative: the sizes are written to nine digits
constexpr double kVolumeTolerance = 1e-6;

double volume_mm3(const ExportedStage& stage) {
  double sum = 0;
  for (std::size_t j = 0; j < stage.radii_mm.size(); ++j)
    sum += std::numbers::pi * stage.radii_mm[j] * stage.radii_mm[j] * stage.lengths_mm[j];
  return sum;
}

// Largest relative difference, infinite where the lists are not as long.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= worst * std::abs(b[i]))) worst = std::abs(a[i] - b[i]) / std::abs(b[i]);
  return worst;
}

double least(const std::vector<double>& values) {
  return values.empty() ? std::numeric_limits<double>::infinity()
                        : *std::min_element(values.begin(), values.end());
}

void claim_counts(const ExportedPrinter& result, Verdict* verdict) {
  bool holds = true;
  std::string measured;
  for (const ExportedStage& stage : result.stages) {
    const bool listed = stage.radii_mm.size() == stage.lengths_mm.size() &&
                        stage.radii_mm.size() == static_cast<std::size_t>(stage.struts);
    const double volume = listed ? volume_mm3(stage) : 0;
    const bool same =
        !stage.volume_mm3 || std::abs(volume - *stage.volume_mm3) <= kVolumeTolerance * *stage.volume_mm3;
    holds = holds && listed && same;
    measured +=
        fmt::format("{}{}: {} radii, {} lengths of {} struts, {:.6g} mm3", measured.empty() ? "" : "; ",
                    stage.name, stage.radii_mm.size(), stage.lengths_mm.size(), stage.struts, volume);
    if (stage.volume_mm3) measured += fmt::format(" (reported {:.6g})", *stage.volume_mm3);
  }
  verdict->claims.push_back({"struts of each stage", holds, measured});
}

// Neither sizing nor its lower bounds move a node.
void claim_given(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedStage &initial = result.stages[0], &size = result.stages[1];
  double worst = difference(size.lengths_mm, initial.lengths_mm);
  const char* against = "";
  if (result.given) {
    const ExportedFrame& given = *result.given;
    std::vector<double> lengths;
    for (const ExportedStrut& s : given.struts)
      lengths.push_back((given.nodes_mm[s.b] - given.nodes_mm[s.a]).norm());
    worst = std::max(worst, difference(initial.lengths_mm, lengths));
    against = " and those of the frame that was given";
  }
  verdict->claims.push_back(
      {"sizing moves no node", worst <= kWritten,
       fmt::format("lengths before and after sizing{} differ by {:.1e} of them (at most {:.0e})", against,
                   worst, kWritten)});
}

// A radius of sizing stands at or above the initial one, which is its lower bound.
void claim_bounds_of_sizing(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedStage &initial = result.stages[0], &size = result.stages[1];
  const std::size_t count = std::min(initial.radii_mm.size(), size.radii_mm.size());
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < count; ++j)
    if (initial.radii_mm[j] > 0) lowest = std::min(lowest, size.radii_mm[j] / initial.radii_mm[j]);
  const double thinnest =
      std::min({least(initial.radii_mm), least(size.radii_mm), least(result.stages[2].radii_mm)});
  verdict->claims.push_back(
      {"radii of each stage", lowest >= 1 - 1e-6 && thinnest >= result.eta_mm * (1 - 1e-6),
       fmt::format(
           "the thinnest of all is {:.4f} mm (at least {:.4f}), sized radii are {:.6f} of the initial "
           "ones or more",
           thinnest, result.eta_mm, lowest)});
}

}  // namespace

void claim_stages(const ExportedPrinter& result, Verdict* verdict) {
  if (result.stages.empty()) return;
  claim_counts(result, verdict);
  claim_given(result, verdict);
  if (!result.infeasible()) claim_bounds_of_sizing(result, verdict);
}

}  // namespace skinframe::check
