// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/solid_reference.h"

#include <algorithm>
#include <cmath>

#include "worker/skin/triangle_tree.h"
#include "worker/solid/contact.h"
#include "worker/stress/lattice.h"
#include "worker/stress/quadratic_solid.h"
#include "worker/verify/foot.h"
#include "worker/verify/shell_models.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

// Weight alone, the loads by their names in order of first use, then the pinches.
std::vector<SolidCase> solid_cases(const VerifyInput& in, const FineSkin& fine,
                                   const std::vector<PinchSite>& pinches) {
  std::vector<SolidCase> cases{{"self-weight", true, {}}};
  for (const StressLoad& load : in.loads) {
    auto it =
        std::find_if(cases.begin(), cases.end(), [&](const SolidCase& c) { return c.name == load.name; });
    if (it == cases.end()) it = cases.insert(cases.end(), {load.name, true, {}});
    it->loads.push_back(load);
  }
  for (const PinchSite& site : pinches) {
    const Vector3d near = fine.frame.nodes_mm[site.node], far = fine.frame.nodes_mm[site.opposite];
    const Vector3d push = kPinchForceN * (far - near).normalized();
    cases.push_back(
        {"pinch", false, {{"pinch", near, push, kPinchRadiusMm}, {"pinch", far, -push, kPinchRadiusMm}}});
  }
  return cases;
}

LoadFigures figures_of(const SolidCase& solid_case, const SolidAnswer& answer) {
  LoadFigures out;
  out.name = solid_case.name;
  out.max_displacement_mm = answer.max_displacement_mm;
  out.at_mm = answer.at_mm;
  double size = 0;
  for (const StressLoad& load : solid_case.loads) size += load.force_n.norm();
  if (size > 0) out.load_displacement_mm = answer.external_work_n_mm / size;
  return out;
}

// Tetrahedra grow by this share of the way from the foot; where there are too many, a foot this much coarser.
constexpr double kGrowth = 0.3, kCoarser = 1.4;

}  // namespace

Result<StandingSolid> standing_solid(const Skin& skin, const TriangleMesh& body, double held_top_mm,
                                     const SolidSpacing& spacing, const RunContext& context) {
  const auto level = [&](const Vector3d& p) { return skin.field.at(p); };
  const Foot foot = foot_of(body, held_top_mm);
  const TriangleTree at_foot(foot.surface);
  const bool may_grade =
      foot.area_mm2 > 0 && spacing.body_mm >= least_spacing_mm(skin.body_box_mm, kMostGradedCells);
  double finest = foot.width_mm / spacing.across_foot;
  for (;;) {
    const bool graded = may_grade && finest < spacing.body_mm;
    auto mesh =
        graded ? fill_with_graded_tetrahedra(
                     level, skin.body_box_mm, spacing.body_mm,
                     [&](const Vector3d& p) { return finest + kGrowth * at_foot.distance_mm(p); }, context)
               : fill_with_tetrahedra(level, skin.body_box_mm, spacing.body_mm, context);
    if (!mesh) return mesh.error();
    if (graded && mesh->tets.size() > spacing.most_tetrahedra) {
      finest *= kCoarser;
      continue;
    }
    StandingSolid out;
    out.mesh = largest_component(std::move(mesh).value());
    out.held_below_mm = held_height_mm(out.mesh, foot);
    out.foot_area_mm2 = foot.area_mm2;
    return out;
  }
}

Result<DesignFigures> assess_solid(const VerifyInput& in, const FineSkin& fine,
                                   const std::vector<PinchSite>& pinches, const RunContext& context) {
  const double spacing = std::max(std::cbrt(kTetsACell * in.solid_volume_mm3 / kSolidTetrahedra),
                                  least_spacing_mm(in.skin.body_box_mm));
  double held_top = in.skin.plate_z_mm + kContactToleranceMm;
  if (const auto shells = contact_height_mm(in.problem))
    held_top = std::max(held_top, *shells - in.skin.thickness_mm);
  const auto solid = standing_solid(in.skin, in.body, held_top, {.body_mm = spacing}, context);
  if (!solid) return solid.error();
  const double top = solid->held_below_mm;
  const Material& material = in.problem.material;
  const std::vector<SolidCase> cases = solid_cases(in, fine, pinches);
  const auto answers = solve_quadratic_solid(
      solid->mesh, {material.tensile_modulus_mpa, kPoissonRatio}, material.weight_density_n_mm3(),
      [top](const Vector3d& p) { return p.z() <= top; }, cases, context);
  if (!answers) return answers.error();
  DesignFigures out;
  out.weight_g = in.solid_volume_mm3 * material.density_g_cm3 * 1e-3;
  const std::size_t loads = cases.size() - pinches.size();
  for (std::size_t c = 0; c < loads; ++c) out.loads.push_back(figures_of(cases[c], (*answers)[c]));
  if (pinches.empty()) return out;
  std::vector<PinchedSite> sites;
  for (std::size_t c = loads; c < cases.size(); ++c)
    sites.push_back({{cases[c].loads[0].point_mm, cases[c].loads[1].point_mm},
                     (*answers)[c].external_work_n_mm / kPinchForceN});
  out.pinch = figures_of_sites(std::move(sites));
  return out;
}

}  // namespace skinframe
