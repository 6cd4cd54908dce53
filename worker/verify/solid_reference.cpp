// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/solid_reference.h"

#include <algorithm>
#include <cmath>

#include "worker/solid/contact.h"
#include "worker/stress/lattice.h"
#include "worker/stress/quadratic_solid.h"
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

}  // namespace

Result<DesignFigures> assess_solid(const VerifyInput& in, const FineSkin& fine,
                                   const std::vector<PinchSite>& pinches, const RunContext& context) {
  const double spacing = std::max(std::cbrt(kTetsACell * in.solid_volume_mm3 / kSolidTetrahedra),
                                  least_spacing_mm(in.skin.body_box_mm));
  auto mesh = fill_with_tetrahedra([&](const Vector3d& p) { return in.skin.field.at(p); },
                                   in.skin.body_box_mm, spacing, context);
  if (!mesh) return mesh.error();
  const double top = in.skin.plate_z_mm + kContactToleranceMm;
  const Material& material = in.problem.material;
  const std::vector<SolidCase> cases = solid_cases(in, fine, pinches);
  const auto answers = solve_quadratic_solid(
      *mesh, {material.tensile_modulus_mpa, kPoissonRatio}, material.weight_density_n_mm3(),
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
