// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

bool positive(double x) { return std::isfinite(x) && x > 0; }

bool material_holds(const Structure& s) {
  return positive(s.material.modulus_mpa) && s.material.poisson_ratio >= 0 &&
         s.material.poisson_ratio <= 0.49 && std::isfinite(s.weight_density_n_mm3) &&
         s.weight_density_n_mm3 >= 0;
}

}  // namespace

ShellTriangle Structure::shell(std::size_t i) const {
  const StructureShell& s = shells[i];
  return {{nodes_mm[s.nodes[0]], nodes_mm[s.nodes[1]], nodes_mm[s.nodes[2]]}, s.thickness_mm};
}

RigidStrut Structure::strut(std::size_t j) const {
  const StructureStrut& s = struts[j];
  return {s.shape, {nodes_mm[s.nodes[0]], nodes_mm[s.nodes[1]]}, s.arm, s.arm_mm, s.radius_mm};
}

Status validate(const Structure& s) {
  const int n = static_cast<int>(s.nodes_mm.size());
  if (!material_holds(s))
    return invalid_input("the structure needs a modulus above 0, a Poisson ratio in [0, 0.49] and a weight");
  if (s.held.size() != s.nodes_mm.size())
    return invalid_input(fmt::format("held: {} entries for {} nodes", s.held.size(), n));
  for (int i = 0; i < n; ++i)
    if (!s.nodes_mm[i].allFinite()) return invalid_input(fmt::format("nodes[{}]: not finite", i));
  const auto in_range = [n](const auto& nodes) {
    return std::all_of(nodes.begin(), nodes.end(), [n](int v) { return v >= 0 && v < n; });
  };
  for (std::size_t i = 0; i < s.shells.size(); ++i)
    if (!in_range(s.shells[i].nodes) || !positive(s.shells[i].thickness_mm) ||
        !positive(shell_area_mm2(s.shell(i))))
      return invalid_input(fmt::format("shells[{}]: no triangle of positive area and thickness", i));
  for (std::size_t j = 0; j < s.struts.size(); ++j) {
    const StructureStrut& strut = s.struts[j];
    if (!in_range(strut.nodes) || !positive(strut.radius_mm) || !(strut.arm_mm >= 0) ||
        !positive(rigid_strut_length_mm(s.strut(j))))
      return invalid_input(fmt::format("struts[{}]: no strut of positive length and radius", j));
  }
  return ok_status();
}

ShellVector freedoms_of(const StructureShell& shell, const Eigen::Ref<const Eigen::VectorXd>& column) {
  ShellVector d;
  for (int i = 0; i < 3; ++i) d.segment<6>(6 * i) = column.segment<6>(6 * shell.nodes[i]);
  return d;
}

StrutVector freedoms_of(const StructureStrut& strut, const Eigen::Ref<const Eigen::VectorXd>& column) {
  StrutVector d;
  for (int i = 0; i < 2; ++i) d.segment<6>(6 * i) = column.segment<6>(6 * strut.nodes[i]);
  return d;
}

Eigen::VectorXd self_weight_n(const Structure& s) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(s.nodes_mm.size()));
  for (std::size_t i = 0; i < s.shells.size(); ++i) {
    const double third = s.weight_density_n_mm3 * s.shells[i].thickness_mm * shell_area_mm2(s.shell(i)) / 3;
    for (const int v : s.shells[i].nodes) f[6 * v + 2] -= third;
  }
  for (std::size_t j = 0; j < s.struts.size(); ++j) {
    const StrutVector w = rigid_strut_weight(s.strut(j), s.material, s.weight_density_n_mm3);
    for (int i = 0; i < 2; ++i) f.segment<6>(6 * s.struts[j].nodes[i]) += w.segment<6>(6 * i);
  }
  return f;
}

double structure_volume_mm3(const Structure& s) {
  double volume = 0;
  for (std::size_t i = 0; i < s.shells.size(); ++i)
    volume += s.shells[i].thickness_mm * shell_area_mm2(s.shell(i));
  for (std::size_t j = 0; j < s.struts.size(); ++j)
    volume += section_of(s.struts[j].shape, s.struts[j].radius_mm, s.material.poisson_ratio).area *
              rigid_strut_length_mm(s.strut(j));
  return volume;
}

}  // namespace skinframe
