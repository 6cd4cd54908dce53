// SPDX-License-Identifier: GPL-3.0-or-later
// Proof that no areas within the box keep the limits: a dual proof (dual_proof.h) of weight 0 whose value is
// positive. Of one load case where that is enough, of several together or with balance where it is not.
//
// Guarantee: what is returned has been evaluated in mm and N from the proof alone, and exceeds rounding:
// value > kCertain * normalisation. No certificate means nothing: the relaxation may be feasible where the
// problem is not.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "worker/optimize/dual_proof.h"

namespace skinframe {

inline constexpr double kCertain = 1e-7;
inline constexpr int kMostCertifiedCases = 3;

struct InfeasibilityCertificate {
  DualProof proof;
  AreaBox box;
  double value = 0, normalisation = 0;  // of dual_value
  // Limits of (2), (3) and (6) this many times as wide are still out of reach by the same proof: what is
  // reachable lies between it and the best that was found. 1 where balance takes part.
  double proven_ratio = 1;
  std::string constraint;  // "displacement", "stress", "balance", or several of them by "and"
};

struct CertificateRequest {
  AreaBox box;
  std::vector<double> start_mm2;  // near the best reachable
  double feasibility_tolerance = 0;
  std::function<bool()> cancelled = [] { return false; };
};

// Of displacement and stress limits, with balance where these alone are not enough.
std::optional<InfeasibilityCertificate> certify_infeasible(const FrameProblem& problem,
                                                           const CertificateRequest& request);

// Of balance alone: Farkas' lemma for its rows, which are linear in A.
std::optional<InfeasibilityCertificate> certify_unbalanced(const FrameProblem& problem,
                                                           const CertificateRequest& request);

}  // namespace skinframe
