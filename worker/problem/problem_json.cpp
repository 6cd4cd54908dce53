// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/problem_file.h"

namespace skinframe {
namespace {

using nlohmann::json;

template <class Vector>
json list_of(const Vector& v) {
  json list = json::array();
  for (Eigen::Index i = 0; i < v.size(); ++i) list.push_back(v[i]);
  return list;
}

json list_of(const std::vector<Eigen::Vector3d>& vectors) {
  json list = json::array();
  for (const Eigen::Vector3d& v : vectors) list.push_back(list_of(v));
  return list;
}

json number_or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json material_json(const Material& m) {
  return {{"id", m.id},
          {"tensile_modulus_mpa", m.tensile_modulus_mpa},
          {"shear_modulus_mpa", m.shear_modulus_mpa},
          {"tensile_strength_mpa", number_or_null(m.tensile_strength_mpa)},
          {"shear_strength_mpa", number_or_null(m.shear_strength_mpa)},
          {"slenderness", number_or_null(m.slenderness)},
          {"density_g_cm3", m.density_g_cm3}};
}

json fixed_json(const std::vector<std::array<bool, 3>>& fixed) {
  json list = json::array();
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    std::string axes;
    for (int axis = 0; axis < 3; ++axis)
      if (fixed[i][axis]) axes += static_cast<char>('x' + axis);
    if (!axes.empty()) list.push_back({{"node", i}, {"axes", axes}});
  }
  return list;
}

json forces_json(const std::vector<Eigen::Vector3d>& force_n) {
  json list = json::array();
  for (std::size_t i = 0; i < force_n.size(); ++i)
    if (!force_n[i].isZero(0)) list.push_back({{"node", i}, {"force_n", list_of(force_n[i])}});
  return list;
}

}  // namespace

json to_json(const FrameProblem& problem, const std::vector<double>& radii_mm,
             const std::vector<std::vector<Eigen::Vector3d>>& displacements_mm) {
  json document{{"mechanics", to_string(problem.element)},
                {"material", material_json(problem.material)},
                {"nodes", list_of(problem.frame.nodes_mm)},
                {"fixed", fixed_json(problem.fixed)},
                {"displacement_limit_mm", number_or_null(problem.displacement_limit_mm)}};
  json& struts = document["struts"] = json::array();
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j) {
    const Strut& strut = problem.frame.struts[j];
    struts.push_back({{"a", strut.a},
                      {"b", strut.b},
                      {"skin", strut.is_skin},
                      {"min_radius_mm", problem.bounds[j].min_mm},
                      {"max_radius_mm", problem.bounds[j].max_mm}});
    if (!radii_mm.empty()) struts.back()["radius_mm"] = radii_mm[j];
  }
  json& cases = document["load_cases"] = json::array();
  for (std::size_t k = 0; k < problem.load_cases.size(); ++k) {
    const LoadCase& load = problem.load_cases[k];
    cases.push_back({{"name", load.name}, {"gravity", load.gravity}, {"forces", forces_json(load.force_n)}});
    if (!displacements_mm.empty()) cases.back()["displacements_mm"] = list_of(displacements_mm[k]);
  }
  json& free_nodes = document["free_nodes"] = json::array();
  for (std::size_t i = 0; i < problem.free_nodes.size(); ++i)
    if (problem.free_nodes[i]) free_nodes.push_back(i);
  if (!problem.skin_weight_n.empty()) document["skin_weight_n"] = problem.skin_weight_n;
  if (problem.skin_mass.weight_n > 0)
    document["skin_mass"] = {{"weight_n", problem.skin_mass.weight_n},
                             {"centroid_mm", list_of(problem.skin_mass.centroid_mm)}};
  if (!problem.balance.empty()) {
    json& planes = document["balance_half_planes"] = json::array();
    for (const HalfPlane& plane : problem.balance)
      planes.push_back({{"normal", list_of(plane.normal)}, {"offset_mm", plane.offset_mm}});
  }
  if (!problem.frame.skin_triangles.empty()) document["skin_triangles"] = problem.frame.skin_triangles;
  return document;
}

}  // namespace skinframe
