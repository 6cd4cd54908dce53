// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/shell_models.h"

#include <algorithm>
#include <limits>

#include "worker/mechanics/evaluation.h"
#include "worker/solid/contact.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

Structure bare(const FrameProblem& problem, const Skin& skin, const FineSkin& fine,
               const std::vector<double>& wall_mm) {
  Structure s;
  s.material = {problem.material.tensile_modulus_mpa, kPoissonRatio};
  s.weight_density_n_mm3 = problem.material.weight_density_n_mm3();
  const auto& nodes = fine.frame.nodes_mm;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    s.nodes_mm.push_back(nodes[i] + (skin.thickness_mm - wall_mm[i] / 2) * fine.normals[i]);
  for (const auto& t : fine.frame.skin_triangles)
    s.shells.push_back({t, (wall_mm[t[0]] + wall_mm[t[1]] + wall_mm[t[2]]) / 3});
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool own = i < static_cast<std::size_t>(problem.frame.skin_node_count);
    const bool stuck = fine.in_contact[i] || (own && problem.fixed[i][2]);
    s.held.push_back(stuck ? HeldFreedoms{true, true, true, false, false, false} : kFree);
  }
  return s;
}

void add_skin_strut(const FineSkin& fine, const std::vector<int>& chain, double radius_mm, double arm_mm,
                    int origin, Structure& s) {
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    StructureStrut part;
    part.nodes = {chain[i], chain[i + 1]};
    part.shape = StrutShape::kHalfDisc;
    part.arm = {-fine.normals[chain[i]], -fine.normals[chain[i + 1]]};
    part.arm_mm = arm_mm;
    part.radius_mm = radius_mm;
    part.origin = origin;
    s.struts.push_back(part);
  }
}

}  // namespace

std::optional<double> contact_height_mm(const FrameProblem& problem) {
  std::optional<double> height;
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < problem.frame.skin_node_count; ++i) {
    const double z = problem.frame.nodes_mm[i].z();
    lowest = std::min(lowest, z);
    if (problem.fixed[i][2]) height = std::max(height.value_or(z), z);
  }
  if (height) height = std::max(*height, lowest + kContactToleranceMm);
  return height;
}

Structure skin_alone_structure(const FrameProblem& problem, const Skin& skin, const FineSkin& fine) {
  return bare(problem, skin, fine, std::vector<double>(fine.frame.nodes_mm.size(), skin.thickness_mm));
}

Structure hollow_structure(const FrameProblem& problem, const Skin& skin, const FineSkin& fine,
                           const std::vector<double>& wall_mm) {
  return bare(problem, skin, fine, wall_mm);
}

Structure skin_frame_structure(const FrameProblem& problem, const std::vector<double>& radii_mm,
                               const Skin& skin, const FineSkin& fine) {
  Structure s = skin_alone_structure(problem, skin, fine);
  const Frame& frame = problem.frame;
  const double arm_mm = skin.thickness_mm / 2;
  const int first_internal = static_cast<int>(s.nodes_mm.size());
  for (std::size_t i = frame.skin_node_count; i < frame.nodes_mm.size(); ++i) {
    s.nodes_mm.push_back(frame.nodes_mm[i]);
    const auto& fixed = problem.fixed[i];
    s.held.push_back({fixed[0], fixed[1], fixed[2], false, false, false});
  }
  const auto node_of = [&](int v) {
    return v < frame.skin_node_count ? v : first_internal + v - frame.skin_node_count;
  };
  const auto arm_of = [&](int v) {
    return v < frame.skin_node_count ? Vector3d(-fine.normals[v]) : Vector3d(Vector3d::Zero());
  };
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    if (radii_mm[j] < kVanishedRadiusMm) continue;
    const Strut& strut = frame.struts[j];
    const int origin = static_cast<int>(j);
    if (strut.is_skin) {
      add_skin_strut(fine, fine.chains[j], radii_mm[j], arm_mm, origin, s);
      continue;
    }
    StructureStrut part;
    part.arm_mm = arm_mm;
    part.radius_mm = radii_mm[j];
    part.origin = origin;
    const int middle = static_cast<int>(s.nodes_mm.size());
    const Vector3d from = s.nodes_mm[node_of(strut.a)] + arm_mm * arm_of(strut.a),
                   to = s.nodes_mm[node_of(strut.b)] + arm_mm * arm_of(strut.b);
    s.nodes_mm.push_back((from + to) / 2);
    s.held.push_back(kFree);
    part.nodes = {node_of(strut.a), middle};
    part.arm = {arm_of(strut.a), Vector3d::Zero()};
    s.struts.push_back(part);
    part.nodes = {middle, node_of(strut.b)};
    part.arm = {Vector3d::Zero(), arm_of(strut.b)};
    s.struts.push_back(part);
  }
  return s;
}

Eigen::VectorXd load_column(const Structure& s, const LoadCase& load_case) {
  Eigen::VectorXd f = load_case.gravity
                          ? self_weight_n(s)
                          : Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(s.nodes_mm.size()));
  for (std::size_t i = 0; i < load_case.force_n.size(); ++i)
    f.segment<3>(6 * static_cast<Eigen::Index>(i)) += load_case.force_n[i];
  return f;
}

}  // namespace skinframe
