// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

constexpr double kDeepestInSkins = 1;   // of a finger, which presses on the middle of the skin
constexpr double kFloat = 1e-5;         // relative: the file holds floats
constexpr double kSame = 1e-9;          // relative: of figures in the same file
constexpr double kTieMm = 1e-3;         // of two fingers equally near
constexpr double kBalanced = 1e-8;      // of reactions against what acts
constexpr double kEven = 0.01;          // relative: rows nearer than that are draws
constexpr double kHollowVolume = 0.02;  // relative: the wall is found by sampling, beside the error here

bool close(double a, double b, double relative) {
  return std::abs(a - b) <= relative * std::max({std::abs(a), std::abs(b), 1e-12});
}

bool same(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && (!a || close(*a, *b, kSame));
}

const ExportedDeformation* deformation_of(const ExportedVerification& v, const std::string& load) {
  for (const ExportedDeformation& d : v.deformations)
    if (d.load == load) return &d;
  return nullptr;
}

// Every load case has its file, and the file the reported largest displacement; the frame's skin nodes are
// its first vertices, half a skin off them, and stand still where the frame is held.
void claim_displacements(const ExportedPrinter& result, const ExportedVerification& v, Verdict* verdict) {
  const ExportedFrame& frame = result.frame;
  std::string wrong;
  double worst = 0, furthest = 0, held = 0;
  for (const ExportedLoadCase& load_case : frame.load_cases) {
    const auto load = std::find_if(v.loads.begin(), v.loads.end(),
                                   [&](const ExportedLoadFigures& l) { return l.name == load_case.name; });
    const ExportedDeformation* file = deformation_of(v, load_case.name);
    if (load == v.loads.end() || file == nullptr) {
      wrong = fmt::format("load \"{}\" has no figures or no file", load_case.name);
      continue;
    }
    double most = 0;
    for (const auto& d : file->displacement_mm) most = std::max(most, d.norm());
    if (!close(most, load->max_displacement_mm, kFloat))
      wrong = fmt::format("load \"{}\": {:.6g} mm in its file", load_case.name, most);
    worst = std::max(worst, load->max_displacement_mm);
    std::vector<char> of_skin(frame.nodes_mm.size(), 0);
    for (const auto& t : frame.skin_triangles)
      for (const int i : t) of_skin[i] = 1;
    for (std::size_t i = 0; i < frame.nodes_mm.size() && i < file->at_mm.size(); ++i) {
      if (!of_skin[i]) continue;
      furthest = std::max(furthest, (file->at_mm[i] - frame.nodes_mm[i]).norm());
      if (frame.fixed[i][2]) held = std::max(held, file->displacement_mm[i].norm());
    }
  }
  const bool whole = close(worst, v.max_displacement_mm, kSame);
  verdict->claims.push_back(
      {"displacement (verified)",
       wrong.empty() && whole && held == 0 && furthest <= 0.5 * result.skin_thickness_mm + 1e-3,
       fmt::format(
           "{} load cases, at most {:.6g} mm in the figures of loads, reported {:.6g} mm; vertices up to "
           "{:.3f} mm from their nodes, held ones move {:.1g} mm{}{}",
           frame.load_cases.size(), worst, v.max_displacement_mm, furthest, held, wrong.empty() ? "" : "; ",
           wrong)});
}

void claim_figures(const ExportedVerification& v, Verdict* verdict) {
  double stress = 0;
  std::optional<double> buckling;
  for (const ExportedLoadFigures& load : v.loads) {
    stress = std::max({stress, load.max_skin_stress_mpa, load.max_strut_stress_mpa});
    if (load.buckling_factor)
      buckling = std::min(buckling.value_or(*load.buckling_factor), *load.buckling_factor);
  }
  const bool safe =
      !v.safety_factor || (v.strength_mpa && close(*v.safety_factor, *v.strength_mpa / stress, kSame));
  verdict->claims.push_back(
      {"stress and buckling (verified)",
       close(stress, v.max_stress_mpa, kSame) && same(buckling, v.buckling_factor) && safe &&
           std::max(v.balance_force, v.balance_moment) <= kBalanced,
       fmt::format(
           "largest stress {:.4g} MPa (reported {:.4g}), safety factor {}, buckling factor {}, reactions "
           "off balance by {:.1e}",
           stress, v.max_stress_mpa, v.safety_factor ? fmt::format("{:.4g}", *v.safety_factor) : "none",
           v.buckling_factor ? fmt::format("{:.4g}", *v.buckling_factor) : "none",
           std::max(v.balance_force, v.balance_moment))});
}

// Mean and worst are those of the sites; every finger is on the skin, on either side of the object, and the
// map shows at each vertex what its nearest finger does.
void claim_pinch(const ExportedPrinter& result, const ExportedVerification& v, const Surface& outer,
                 Verdict* verdict) {
  if (!v.pinch_max_mm && v.pinch_sites.empty() && !v.pinch) return;
  double mean = 0, worst = 0, furthest = 0, deepest = 0;
  for (const ExportedPinchSite& site : v.pinch_sites) {
    mean += site.closing_mm / static_cast<double>(v.pinch_sites.size());
    worst = std::max(worst, site.closing_mm);
    for (const Eigen::Vector3d& finger : site.fingers_mm)
      deepest = std::max(deepest, outer.distance_mm(finger));
  }
  bool shown = v.pinch && !v.pinch_sites.empty();
  for (std::size_t i = 0; shown && i < v.pinch->at_mm.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const ExportedPinchSite& site : v.pinch_sites)
      for (const Eigen::Vector3d& finger : site.fingers_mm)
        nearest = std::min(nearest, (finger - v.pinch->at_mm[i]).norm());
    bool known = false;  // of the nearest fingers; floats make ties of what is none
    for (const ExportedPinchSite& site : v.pinch_sites)
      for (const Eigen::Vector3d& finger : site.fingers_mm)
        known = known || ((finger - v.pinch->at_mm[i]).norm() <= nearest + kTieMm &&
                          close(site.closing_mm, v.pinch->closing_mm[i], kFloat));
    shown = known;
    furthest = std::max(furthest, nearest);
  }
  const bool agree = v.pinch_max_mm && v.pinch_mean_mm && close(worst, *v.pinch_max_mm, kSame) &&
                     close(mean, *v.pinch_mean_mm, kSame) && mean >= 0;  // 0: all that is pinched is held
  verdict->claims.push_back(
      {"pinch (verified)", agree && shown && deepest <= kDeepestInSkins * result.skin_thickness_mm,
       fmt::format(
           "{} sites, closing by {:.4g} mm in the mean and {:.4g} mm at most, fingers up to {:.3f} mm "
           "below the surface; the map {}, its vertices up to {:.1f} mm from a finger",
           v.pinch_sites.size(), mean, worst, deepest, shown ? "agrees" : "does not agree", furthest)});
}

// Who is better, from the rows' own figures, which are the worst of each design's loads; a frame that wins no
// row must not be called better.
void claim_comparison(const ExportedVerification& v, Verdict* verdict) {
  int ours = 0, hollow = 0, lies = 0;
  for (const ExportedRow& row : v.rows) {
    std::string better = "even";
    if (row.skin_frame && row.hollow && !close(*row.skin_frame, *row.hollow, kEven))
      better = (*row.skin_frame < *row.hollow) != (row.figure == "buckling_factor") ? "skin-frame" : "hollow";
    ours += better == "skin-frame";
    hollow += better == "hollow";
    lies += better != row.better;
  }
  const auto figure = [&](const char* name) -> const ExportedRow* {
    for (const ExportedRow& row : v.rows)
      if (row.figure == name) return &row;
    return nullptr;
  };
  const ExportedRow *moved = figure("max_displacement_mm"), *pinched = figure("pinch_max_mm");
  const bool agree = moved && pinched && same(moved->skin_frame, v.max_displacement_mm) &&
                     same(moved->hollow, v.hollow_max_displacement_mm) &&
                     same(pinched->skin_frame, v.pinch_max_mm);
  for (const ExportedRow& row : v.of_designs) {
    const ExportedRow* told = figure(row.figure.c_str());
    lies += !told || !same(told->skin_frame, row.skin_frame) || !same(told->hollow, row.hollow);
  }
  const bool boasts = v.verdict.starts_with("better than");
  verdict->claims.push_back({"comparison with a hollow (verified)",
                             lies == 0 && agree && boasts == (ours > 0),
                             fmt::format("{} rows for the skin-frame, {} for the hollow, {} told wrongly: {}",
                                         ours, hollow, lies, v.verdict)});
}

// The hollow has the printed volume: the volume that lies less deep than its wall.
void claim_hollow(const ExportedPrinter& result, const ExportedVerification& v, const TriangleMesh& body,
                  const Surface& outer, Verdict* verdict) {
  if (!v.hollow_thickness_mm) return;
  const WallSample wall =
      sample_wall(outer, bounding_box(body), *v.hollow_thickness_mm, result.solid_volume_mm3);
  const double allowed = wall.error_mm3 + kHollowVolume * result.printed_volume_mm3;
  verdict->claims.push_back(
      {"hollow of equal mass", std::abs(wall.volume_mm3 - result.printed_volume_mm3) <= allowed,
       fmt::format("a wall of {:.3f} mm holds {:.0f} mm3 by sampling (+- {:.0f}), printed are {:.0f} mm3",
                   *v.hollow_thickness_mm, wall.volume_mm3, wall.error_mm3, result.printed_volume_mm3)});
}

}  // namespace

void claim_verified(const ExportedPrinter& result, const TriangleMesh& body, const Surface& outer,
                    Verdict* verdict) {
  if (!result.verification) {
    verdict->notes.push_back(
        "no verification by the valid model: the paper's model alone speaks for the frame");
    return;
  }
  const ExportedVerification& v = *result.verification;
  if (!v.verified) {
    verdict->claims.push_back({"what is not verified claims nothing",
                               !v.figures_without && v.deformations.empty(),
                               "labelled \"not verified\", with a reason and without figures or files"});
    return;
  }
  claim_displacements(result, v, verdict);
  claim_figures(v, verdict);
  claim_pinch(result, v, outer, verdict);
  claim_comparison(v, verdict);
  claim_hollow(result, v, body, outer, verdict);
}

}  // namespace skinframe::check
