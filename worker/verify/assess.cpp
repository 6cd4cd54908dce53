// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/assess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "worker/structure/buckling.h"
#include "worker/verify/shell_models.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kMostRefinements = 3;

double worse(const Balance& balance) { return std::max(balance.force, balance.moment); }

NodalColumns load_columns(const Structure& s, const std::vector<LoadCase>& cases) {
  NodalColumns f(6 * static_cast<Eigen::Index>(s.nodes_mm.size()), static_cast<Eigen::Index>(cases.size()));
  for (std::size_t c = 0; c < cases.size(); ++c) f.col(c) = load_column(s, cases[c]);
  return f;
}

// Work of the external forces and the sum of their sizes.
std::pair<double, double> external_work(const LoadCase& load_case, const VectorXd& d) {
  double work = 0, size = 0;
  for (std::size_t i = 0; i < load_case.force_n.size(); ++i) {
    work += load_case.force_n[i].dot(d.segment<3>(6 * static_cast<Eigen::Index>(i)));
    size += load_case.force_n[i].norm();
  }
  return {work, size};
}

LoadFigures measure(const Structure& s, std::size_t skin_nodes, const LoadCase& load_case,
                    const VectorXd& d) {
  LoadFigures out;
  out.name = load_case.name;
  for (std::size_t i = 0; i < skin_nodes; ++i) {
    const double size = d.segment<3>(6 * static_cast<Eigen::Index>(i)).norm();
    if (size <= out.max_displacement_mm) continue;
    out.max_displacement_mm = size;
    out.at_mm = s.nodes_mm[i];
  }
  const auto [work, size] = external_work(load_case, d);
  if (size > 0) out.load_displacement_mm = work / size;
  for (std::size_t i = 0; i < s.shells.size(); ++i) {
    const ShellTriangle shell = s.shell(i);
    const double stress = shell_stress(shell, s.material, freedoms_of(s.shells[i], d)).von_mises_mpa;
    if (stress <= out.skin_stress_mpa) continue;
    out.skin_stress_mpa = stress;
    out.stress_at_mm = (shell.corner_mm[0] + shell.corner_mm[1] + shell.corner_mm[2]) / 3;
  }
  for (std::size_t j = 0; j < s.struts.size(); ++j) {
    const RigidStrut strut = s.strut(j);
    const double stress = rigid_strut_stress(strut, s.material, freedoms_of(s.struts[j], d)).von_mises_mpa;
    if (stress <= out.strut_stress_mpa) continue;
    out.strut_stress_mpa = stress;
    if (stress > out.skin_stress_mpa) out.stress_at_mm = (strut.node_mm[0] + strut.node_mm[1]) / 2;
  }
  return out;
}

// Internal struts stand in two parts: the length of both, the larger compression.
void check_euler(const Structure& s, const NodalColumns& displacements, Assessment* out) {
  struct Whole {
    double length_mm = 0, inertia_mm4 = 0, compression_n = 0;
  };
  std::map<int, Whole> struts;
  for (std::size_t j = 0; j < s.struts.size(); ++j) {
    if (s.struts[j].shape != StrutShape::kFullDisc) continue;
    const RigidStrut strut = s.strut(j);
    Whole& whole = struts[s.struts[j].origin];
    whole.length_mm += rigid_strut_length_mm(strut);
    whole.inertia_mm4 = section_of(strut.shape, strut.radius_mm, s.material.poisson_ratio).i_in;
    for (Eigen::Index c = 0; c < displacements.cols(); ++c) {
      const StrutVector d = freedoms_of(s.struts[j], displacements.col(c));
      const double force = rigid_strut_stress(strut, s.material, d).axial_force_n;
      whole.compression_n = std::max(whole.compression_n, -force);
    }
  }
  for (const auto& [origin, whole] : struts) {
    if (!(whole.compression_n > 0)) continue;
    const double factor =
        euler_load_n(s.material.modulus_mpa, whole.inertia_mm4, whole.length_mm) / whole.compression_n;
    if (out->euler_factor && factor >= *out->euler_factor) continue;
    out->euler_factor = factor;
    out->euler_strut = origin;
  }
}

PinchFigures measure_pinches(const Structure& s, const std::vector<PinchSite>& sites, const NodalColumns& f,
                             const NodalColumns& d) {
  std::vector<PinchedSite> pinched;
  for (std::size_t c = 0; c < sites.size(); ++c)
    pinched.push_back(
        {{s.nodes_mm[sites[c].node], s.nodes_mm[sites[c].opposite]}, f.col(c).dot(d.col(c)) / kPinchForceN});
  return figures_of_sites(std::move(pinched));
}

}  // namespace

Result<Assessment> assess(const StructureSolver& solver, const FineSkin& fine,
                          const std::vector<LoadCase>& cases, const std::vector<PinchSite>& pinches,
                          const RunContext& context) {
  const Structure& s = solver.structure();
  const NodalColumns loads = load_columns(s, cases), pinch = pinch_columns(s, fine, pinches);
  NodalColumns all(loads.rows(), loads.cols() + pinch.cols());
  all.leftCols(loads.cols()) = loads;
  all.rightCols(pinch.cols()) = pinch;
  NodalColumns d = solver.solve(all);
  Assessment out;
  out.balance = solver.balance(d, all);
  for (int step = 0; step < kMostRefinements && worse(out.balance) > 0.1 * kBalanceTolerance; ++step) {
    solver.refine(all, &d);
    out.balance = solver.balance(d, all);
  }
  if (!(worse(out.balance) <= kBalanceTolerance))
    return internal_error(
        fmt::format("reactions and loads do not balance: {:.1e} of the forces, {:.1e} of the moments",
                    out.balance.force, out.balance.moment));
  out.displacements = d.leftCols(loads.cols());
  out.figures.weight_g = structure_volume_mm3(s) * s.weight_density_n_mm3 / kGravityMmPerS2 * 1e6;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    if (context.cancelled()) return cancelled_error();
    const auto factor = buckling_factor(solver, d.col(c));
    if (!factor) return factor.error();
    LoadFigures figures = measure(s, fine.frame.nodes_mm.size(), cases[c], d.col(c));
    figures.buckling_factor = *factor;
    out.figures.loads.push_back(std::move(figures));
  }
  if (!pinches.empty()) out.figures.pinch = measure_pinches(s, pinches, pinch, d.rightCols(pinch.cols()));
  check_euler(s, out.displacements, &out);
  return out;
}

Result<Assessment> assess(const Structure& s, const FineSkin& fine, const std::vector<LoadCase>& cases,
                          const std::vector<PinchSite>& pinches, const RunContext& context) {
  const auto solver = StructureSolver::factorise(s, context);
  if (!solver) return solver.error();
  return assess(*solver, fine, cases, pinches, context);
}

std::vector<double> load_works(const StructureSolver& solver, const std::vector<LoadCase>& cases) {
  const NodalColumns f = load_columns(solver.structure(), cases), d = solver.solve(f);
  std::vector<double> works;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const auto [work, size] = external_work(cases[c], d.col(c));
    works.push_back(size > 0 ? work : f.col(c).dot(d.col(c)));
  }
  return works;
}

}  // namespace skinframe
