// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mechanics/frame_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace skinframe {
namespace {

using std::numbers::pi;

bool finite(double value) { return std::isfinite(value); }
bool finite(const std::optional<double>& value) { return !value || std::isfinite(*value); }

Status sizes_agree(const FrameProblem& p) {
  const std::size_t nodes = p.frame.nodes_mm.size(), struts = p.frame.struts.size();
  if (nodes == 0) return invalid_input("the frame has no nodes");
  if (struts == 0) return invalid_input("the frame has no struts");
  if (p.bounds.size() != struts)
    return invalid_input(fmt::format("bounds: {} entries for {} struts", p.bounds.size(), struts));
  if (p.fixed.size() != nodes)
    return invalid_input(fmt::format("fixed: {} entries for {} nodes", p.fixed.size(), nodes));
  if (!p.skin_weight_n.empty() && p.skin_weight_n.size() != nodes)
    return invalid_input(
        fmt::format("skin_weight_n: {} entries for {} nodes", p.skin_weight_n.size(), nodes));
  if (!p.free_nodes.empty() && p.free_nodes.size() != nodes)
    return invalid_input(fmt::format("free_nodes: {} entries for {} nodes", p.free_nodes.size(), nodes));
  for (std::size_t k = 0; k < p.load_cases.size(); ++k)
    if (p.load_cases[k].force_n.size() != nodes)
      return invalid_input(
          fmt::format("load_cases[{}]: {} forces for {} nodes", k, p.load_cases[k].force_n.size(), nodes));
  return ok_status();
}

Status material_holds(const Material& m, ElementModel element) {
  if (!finite(m.tensile_modulus_mpa) || m.tensile_modulus_mpa <= 0)
    return invalid_input("material.tensile_modulus_mpa: must be positive");
  if (element == ElementModel::kPaper && (!finite(m.shear_modulus_mpa) || m.shear_modulus_mpa <= 0))
    return invalid_input("material.shear_modulus_mpa: must be positive for the paper's element");
  if (!finite(m.density_g_cm3) || m.density_g_cm3 < 0)
    return invalid_input("material.density_g_cm3: must not be negative");
  const std::pair<const char*, std::optional<double>> limits[] = {
      {"tensile_strength_mpa", m.tensile_strength_mpa},
      {"shear_strength_mpa", m.shear_strength_mpa},
      {"slenderness", m.slenderness}};
  for (const auto& [name, limit] : limits)
    if (!finite(limit) || (limit && *limit <= 0))
      return invalid_input(fmt::format("material.{}: must be positive, or null for no limit", name));
  return ok_status();
}

Status struts_hold(const FrameProblem& p) {
  const int nodes = static_cast<int>(p.frame.nodes_mm.size());
  for (int i = 0; i < nodes; ++i)
    if (!p.frame.nodes_mm[i].allFinite()) return invalid_input(fmt::format("nodes[{}]: not finite", i));
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(p.frame.struts.size());
  for (std::size_t j = 0; j < p.frame.struts.size(); ++j) {
    const Strut& strut = p.frame.struts[j];
    for (const auto& [name, end] : {std::pair{"a", strut.a}, std::pair{"b", strut.b}})
      if (end < 0 || end >= nodes)
        return invalid_input(fmt::format("struts[{}].{}: {} is not a node (0..{})", j, name, end, nodes - 1));
    if (!(p.frame.length_mm(strut) > 0))
      return invalid_input(fmt::format("struts[{}]: its ends {} and {} coincide", j, strut.a, strut.b));
    const RadiusBounds& b = p.bounds[j];
    if (!finite(b.min_mm) || !finite(b.max_mm) || b.min_mm < 0 || b.max_mm <= 0 || b.min_mm > b.max_mm)
      return invalid_input(fmt::format(
          "struts[{}]: radius bounds {}..{} mm are no interval of positive length", j, b.min_mm, b.max_mm));
    pairs.emplace_back(std::min(strut.a, strut.b), std::max(strut.a, strut.b));
  }
  std::sort(pairs.begin(), pairs.end());
  const auto twice = std::adjacent_find(pairs.begin(), pairs.end());
  if (twice != pairs.end())
    return invalid_input(
        fmt::format("struts: nodes {} and {} are joined twice", twice->first, twice->second));
  return ok_status();
}

Status loads_hold(const FrameProblem& p) {
  for (std::size_t i = 0; i < p.skin_weight_n.size(); ++i)
    if (!finite(p.skin_weight_n[i]) || p.skin_weight_n[i] < 0)
      return invalid_input(fmt::format("skin_weight_n[{}]: must not be negative", i));
  for (std::size_t k = 0; k < p.load_cases.size(); ++k)
    for (std::size_t i = 0; i < p.load_cases[k].force_n.size(); ++i)
      if (!p.load_cases[k].force_n[i].allFinite())
        return invalid_input(fmt::format("load_cases[{}]: the force at node {} is not finite", k, i));
  if (!finite(p.displacement_limit_mm) || (p.displacement_limit_mm && *p.displacement_limit_mm <= 0))
    return invalid_input("displacement_limit_mm: must be positive, or null for no limit");
  if (!finite(p.skin_mass.weight_n) || p.skin_mass.weight_n < 0 || !p.skin_mass.centroid_mm.allFinite())
    return invalid_input("skin_mass: weight must not be negative, centroid must be finite");
  for (std::size_t i = 0; i < p.balance.size(); ++i)
    if (!p.balance[i].normal.allFinite() || !finite(p.balance[i].offset_mm) ||
        std::abs(p.balance[i].normal.norm() - 1) > 1e-6)
      return invalid_input(fmt::format("balance_half_planes[{}]: the normal must be of unit length", i));
  return ok_status();
}

Status free_nodes_hold(const FrameProblem& p) {
  if (p.free_nodes.empty()) return ok_status();
  const std::vector<bool> of_skin = skin_nodes(p.frame), loaded = loaded_nodes(p);
  for (std::size_t i = 0; i < p.free_nodes.size(); ++i) {
    if (!p.free_nodes[i]) continue;
    const auto& axes = p.fixed[i];
    const char* why = axes[0] || axes[1] || axes[2] ? "fixed"
                      : loaded[i]                   ? "loaded"
                      : of_skin[i]                  ? "of the skin"
                                                    : nullptr;
    if (why) return invalid_input(fmt::format("free_nodes: node {} is {}, so it cannot move", i, why));
  }
  return ok_status();
}

}  // namespace

const char* to_string(ElementModel model) {
  switch (model) {
    case ElementModel::kPaper:
      return "paper";
    case ElementModel::kAxial:
      return "axial";
  }
  return "unknown";
}

Status validate(const FrameProblem& problem) {
  if (Status s = sizes_agree(problem); !s.ok()) return s;
  if (Status s = material_holds(problem.material, problem.element); !s.ok()) return s;
  if (Status s = struts_hold(problem); !s.ok()) return s;
  if (Status s = loads_hold(problem); !s.ok()) return s;
  return free_nodes_hold(problem);
}

AreaBounds area_bounds(const FrameProblem& problem, int strut) {
  const RadiusBounds& given = problem.bounds[strut];
  double slender = 0;
  if (problem.material.slenderness)
    slender = problem.frame.length_mm(problem.frame.struts[strut]) / *problem.material.slenderness;
  const double lower = std::max(given.min_mm, slender);
  const bool widened = slender > given.max_mm;
  const double upper = widened ? kSlenderRoom * slender : given.max_mm;
  return {pi * lower * lower, pi * upper * upper, widened};
}

std::vector<bool> skin_nodes(const Frame& frame) {
  std::vector<bool> of_skin(frame.nodes_mm.size(), false);
  for (const Strut& strut : frame.struts)
    if (strut.is_skin) of_skin[strut.a] = of_skin[strut.b] = true;
  return of_skin;
}

std::vector<bool> loaded_nodes(const FrameProblem& problem) {
  std::vector<bool> loaded(problem.frame.nodes_mm.size(), false);
  for (const LoadCase& load : problem.load_cases)
    for (std::size_t i = 0; i < loaded.size(); ++i)
      if (!load.force_n[i].isZero(0)) loaded[i] = true;
  return loaded;
}

double frame_volume_mm3(const Frame& frame, const std::vector<double>& radii_mm) {
  double volume = 0;
  for (std::size_t j = 0; j < frame.struts.size(); ++j)
    volume += pi * radii_mm[j] * radii_mm[j] * frame.length_mm(frame.struts[j]);
  return volume;
}

}  // namespace skinframe
