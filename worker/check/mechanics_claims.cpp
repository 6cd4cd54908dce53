// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's model, assembled here once more from its equations (1)-(3): a strut of area A and length l
// resists the relative displacement of its ends by gamma A / l along its axis and mu A / l across it. The
// pin-jointed model of a frame problem is the same without the latter.
#include <fmt/format.h>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <cmath>
#include <numbers>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

constexpr double kGravity = 9810.0;   // mm/s2
constexpr double kTinyForce = 1e-12;  // N: no load at all
constexpr double kForceTolerance =
    1e-4;  // of the largest nodal force: the residual of the exported displacements
constexpr double kDisplacementTolerance = 1e-4;  // relative, reported against recomputed
constexpr double kLimitTolerance = 1e-4;         // relative, on displacement and stress limits
constexpr double kVanishedRadiusMm = 1e-5;       // a strut thinner than this is absent; the paper's zeta
// A pivot this small against the largest one is none: a mechanism, which a pin-jointed frame may have where
// no load excites it.
constexpr double kNoPivot = 1e-9;

struct Assembled {
  Eigen::SparseMatrix<double> stiffness;  // all axes, supports not yet held
  Eigen::VectorXd strut_weight_n;         // lumped to the nodes, one a node
};

Assembled assemble(const ExportedFrame& frame) {
  const int n = static_cast<int>(frame.nodes_mm.size());
  std::vector<Eigen::Triplet<double>> entries;
  Assembled out{Eigen::SparseMatrix<double>(3 * n, 3 * n), Eigen::VectorXd::Zero(n)};
  const double weight_density = frame.density_g_cm3 * 1e-9 * kGravity;
  for (const ExportedStrut& s : frame.struts) {
    const Eigen::Vector3d e = frame.nodes_mm[s.b] - frame.nodes_mm[s.a];
    const double l = e.norm(), area = std::numbers::pi * s.radius_mm * s.radius_mm;
    const Eigen::Matrix3d along = e * e.transpose() / (l * l);
    const Eigen::Matrix3d k =
        area / l *
        (frame.tensile_modulus_mpa * along + frame.shear_modulus_mpa * (Eigen::Matrix3d::Identity() - along));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        entries.emplace_back(3 * s.a + i, 3 * s.a + j, k(i, j));
        entries.emplace_back(3 * s.b + i, 3 * s.b + j, k(i, j));
        entries.emplace_back(3 * s.a + i, 3 * s.b + j, -k(i, j));
        entries.emplace_back(3 * s.b + i, 3 * s.a + j, -k(i, j));
      }
    out.strut_weight_n[s.a] += 0.5 * weight_density * area * l;
    out.strut_weight_n[s.b] += 0.5 * weight_density * area * l;
  }
  out.stiffness.setFromTriplets(entries.begin(), entries.end());
  return out;
}

Eigen::VectorXd loads(const ExportedFrame& frame, const Assembled& assembled,
                      const ExportedLoadCase& load_case) {
  const int n = static_cast<int>(frame.nodes_mm.size());
  Eigen::VectorXd force(3 * n);
  for (int i = 0; i < n; ++i) {
    force.segment<3>(3 * i) = load_case.force_n[i];
    if (load_case.gravity) force[3 * i + 2] -= assembled.strut_weight_n[i] + frame.skin_weight_n[i];
  }
  return force;
}

// The stiffness with the supports held, factorised.
struct Held {
  std::vector<int> free_axis;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  bool definite = true;

  Held(const ExportedFrame& frame, const Assembled& assembled) {
    const int axes = 3 * static_cast<int>(frame.nodes_mm.size());
    std::vector<int> place(axes, -1);
    for (int i = 0; i < axes; ++i) {
      if (frame.fixed[i / 3][i % 3]) continue;
      place[i] = static_cast<int>(free_axis.size());
      free_axis.push_back(i);
    }
    std::vector<Eigen::Triplet<double>> kept;
    for (int c = 0; c < assembled.stiffness.outerSize(); ++c)
      for (Eigen::SparseMatrix<double>::InnerIterator it(assembled.stiffness, c); it; ++it)
        if (place[it.row()] >= 0 && place[it.col()] >= 0)
          kept.emplace_back(place[it.row()], place[it.col()], it.value());
    if (free_axis.empty()) return;
    Eigen::SparseMatrix<double> reduced(free_axis.size(), free_axis.size());
    reduced.setFromTriplets(kept.begin(), kept.end());
    solver.compute(reduced);
    definite = solver.info() == Eigen::Success &&
               solver.vectorD().minCoeff() > (frame.axial ? kNoPivot * solver.vectorD().maxCoeff() : 0.0);
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& force) const {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(force.size()), right(free_axis.size());
    for (std::size_t k = 0; k < free_axis.size(); ++k) right[k] = force[free_axis[k]];
    const Eigen::VectorXd solved = solver.solve(right);
    for (std::size_t k = 0; k < free_axis.size(); ++k) d[free_axis[k]] = solved[k];
    return d;
  }
};

struct Ratios {
  double axial = 0, shear = 0;
};

Ratios stress_ratios(const ExportedFrame& frame, const Eigen::VectorXd& d) {
  Ratios worst;
  for (const ExportedStrut& s : frame.struts) {
    if (s.radius_mm < kVanishedRadiusMm) continue;
    const Eigen::Vector3d e = frame.nodes_mm[s.b] - frame.nodes_mm[s.a];
    const double l = e.norm();
    const Eigen::Vector3d delta = d.segment<3>(3 * s.b) - d.segment<3>(3 * s.a);
    const double stretch = e.dot(delta) / l;
    const double slip = (delta - stretch * e / l).norm();
    if (frame.tensile_strength_mpa)
      worst.axial = std::max(worst.axial,
                             frame.tensile_modulus_mpa * std::abs(stretch) / l / *frame.tensile_strength_mpa);
    if (frame.shear_strength_mpa && !frame.axial)
      worst.shear = std::max(worst.shear, frame.shear_modulus_mpa * slip / l / *frame.shear_strength_mpa);
  }
  return worst;
}

double largest_node_norm(const Eigen::VectorXd& d) {
  double worst = 0;
  for (int i = 0; i + 2 < d.size(); i += 3) worst = std::max(worst, d.segment<3>(i).norm());
  return worst;
}

bool close(double measured, double reported, double relative) {
  return std::abs(measured - reported) <= relative * std::max({std::abs(measured), std::abs(reported), 1e-9});
}

// What is called infeasible has to break the constraint that it names.
void claim_violation(const ExportedPrinter& result, bool stable, bool displaced, bool stretched, bool sheared,
                     Verdict* verdict) {
  const std::string& name = result.violated_constraint;
  if (name == "balance of the printed mesh") {
    verdict->notes.push_back(
        "infeasible by the balance of the printed mesh, which is not exported: not judged");
    return;
  }
  bool broken = false;
  if (name == "displacement") broken = displaced;
  if (name == "axial stress") broken = stretched;
  if (name == "shear stress") broken = sheared;
  if (name == "equilibrium") broken = !stable;
  if (name == "balance")
    for (const auto& [normal, offset_mm] : result.frame.balance_half_planes)
      broken |= normal.dot(nominal_centre_of_gravity_mm(result.frame).head<2>()) > offset_mm;
  verdict->claims.push_back({"infeasible", broken,
                             fmt::format("the constraint named is \"{}\", and the best frame found {}", name,
                                         broken ? "breaks it" : "does not break it")});
}

}  // namespace

std::vector<Eigen::Vector3d> own_weight_displacements_mm(const ExportedFrame& frame) {
  const Assembled assembled = assemble(frame);
  const Held held(frame, assembled);
  std::vector<Eigen::Vector3d> displacements;
  if (!held.definite || held.free_axis.empty()) return displacements;
  const std::vector<Eigen::Vector3d> no_force(frame.nodes_mm.size(), Eigen::Vector3d::Zero());
  const Eigen::VectorXd d = held.solve(loads(frame, assembled, {"own weight", true, no_force, {}}));
  for (std::size_t i = 0; i < frame.nodes_mm.size(); ++i)
    displacements.push_back(d.segment<3>(3 * static_cast<Eigen::Index>(i)));
  return displacements;
}

void claim_mechanics(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedFrame& frame = result.frame;
  const int n = static_cast<int>(frame.nodes_mm.size());
  const Assembled assembled = assemble(frame);
  const Held held(frame, assembled);
  const bool definite = held.definite;
  const char* model = frame.axial ? "axial model" : "paper model";

  double worst_residual = 0, worst_displacement = 0;
  bool exported_all = true;
  std::string worst_case;
  Ratios worst;
  for (const ExportedLoadCase& load_case : frame.load_cases) {
    const Eigen::VectorXd force = loads(frame, assembled, load_case);
    Eigen::VectorXd d = Eigen::VectorXd::Zero(3 * n);
    if (static_cast<int>(load_case.displacement_mm.size()) == n) {
      for (int i = 0; i < n; ++i) d.segment<3>(3 * i) = load_case.displacement_mm[i];
      const Eigen::VectorXd residual = assembled.stiffness * d - force;
      for (const int i : held.free_axis)
        worst_residual = std::max(worst_residual,
                                  std::abs(residual[i]) / std::max(force.cwiseAbs().maxCoeff(), kTinyForce));
    } else {
      exported_all = false;
    }
    if (definite && !held.free_axis.empty()) {
      d = held.solve(force);
    } else if (!definite && !frame.axial) {
      continue;
    }  // else what was exported has to stand in: its residual is what shows it in equilibrium
    const double largest = largest_node_norm(d);
    if (largest >= worst_displacement) {
      worst_displacement = largest;
      worst_case = load_case.name;
    }
    const Ratios ratios = stress_ratios(frame, d);
    worst.axial = std::max(worst.axial, ratios.axial);
    worst.shear = std::max(worst.shear, ratios.shear);
  }

  const bool stable = definite || (frame.axial && exported_all && worst_residual <= kForceTolerance);
  verdict->claims.push_back(
      {fmt::format("equilibrium ({})", model), stable && exported_all && worst_residual <= kForceTolerance,
       fmt::format(
           "exported displacements leave {:.1e} of the largest nodal force (at most {:.0e}); stiffness {}",
           worst_residual, kForceTolerance, definite ? "positive definite" : "not positive definite")});
  const double limit = frame.displacement_limit_mm.value_or(std::numeric_limits<double>::infinity());
  const bool honest = close(worst_displacement, result.max_displacement_mm, kDisplacementTolerance);
  if (result.infeasible()) {
    const bool same = !result.best_reachable_displacement_mm ||
                      close(worst_displacement, *result.best_reachable_displacement_mm, 1e-2);
    verdict->claims.push_back(
        {fmt::format("best reachable displacement ({})", model), honest && same,
         fmt::format("{:.5f} mm in load case \"{}\", reported {:.5f} mm; limit {:g} mm", worst_displacement,
                     worst_case, result.max_displacement_mm, limit)});
    claim_violation(result, stable, worst_displacement > limit, worst.axial > 1, worst.shear > 1, verdict);
    return;
  }
  verdict->claims.push_back(
      {fmt::format("displacement ({})", model),
       stable && honest && (!result.optimised() || worst_displacement <= limit * (1 + kLimitTolerance)),
       fmt::format("{:.6f} mm in load case \"{}\", reported {:.6f} mm, limit {:g} mm{}", worst_displacement,
                   worst_case, result.max_displacement_mm, limit,
                   result.optimised() ? "" : " (not optimised: no limit claimed)")});
  verdict->claims.push_back(
      {fmt::format("stresses ({})", model),
       stable && close(worst.axial, result.max_axial_ratio, 1e-3) &&
           close(worst.shear, result.max_shear_ratio, 1e-3) &&
           (!result.optimised() || std::max(worst.axial, worst.shear) <= 1 + kLimitTolerance),
       fmt::format("axial {:.4f} and shear {:.4f} of strength (reported {:.4f}, {:.4f}), at most 1",
                   worst.axial, worst.shear, result.max_axial_ratio, result.max_shear_ratio)});
}

}  // namespace skinframe::check
