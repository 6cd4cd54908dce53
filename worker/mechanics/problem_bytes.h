// SPDX-License-Identifier: GPL-3.0-or-later
// A frame and its problem as bytes, for checkpoints (worker/run/bytes.h). What is read says nothing about the
// invariants: ask validate().
#pragma once

#include "worker/mechanics/frame_problem.h"
#include "worker/run/bytes.h"

namespace skinframe {

template <class Archive>
void pass(Archive& archive, Strut& strut) {
  archive(strut.a, strut.b, strut.is_skin);
}

template <class Archive>
void pass(Archive& archive, Frame& frame) {
  archive(frame.nodes_mm, frame.skin_node_count, frame.struts, frame.skin_triangles);
}

template <class Archive>
void pass(Archive& archive, Material& material) {
  archive(material.id, material.tensile_modulus_mpa, material.shear_modulus_mpa,
          material.tensile_strength_mpa, material.shear_strength_mpa, material.slenderness,
          material.density_g_cm3);
}

template <class Archive>
void pass(Archive& archive, RadiusBounds& bounds) {
  archive(bounds.min_mm, bounds.max_mm);
}

template <class Archive>
void pass(Archive& archive, LoadCase& load_case) {
  archive(load_case.name, load_case.gravity, load_case.force_n);
}

template <class Archive>
void pass(Archive& archive, HalfPlane& plane) {
  archive(plane.normal, plane.offset_mm);
}

template <class Archive>
void pass(Archive& archive, FixedMass& mass) {
  archive(mass.weight_n, mass.centroid_mm);
}

template <class Archive>
void pass(Archive& archive, FrameProblem& problem) {
  archive(problem.element, problem.material, problem.frame, problem.bounds, problem.fixed,
          problem.skin_weight_n, problem.load_cases, problem.displacement_limit_mm, problem.balance,
          problem.skin_mass, problem.free_nodes);
}

}  // namespace skinframe
