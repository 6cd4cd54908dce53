// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/optimise/nested_mma.h"

#include <Eigen/CholmodSupport>
#include <cmath>

#include "worker/mechanics/equilibrium.h"
#include "worker/mechanics/strut_element.h"
#include "worker/optimize/uniform_frame.h"

#ifdef SKINFRAME_HAS_NLOPT
#include <nlopt.hpp>
#endif

namespace skinframe::bench {

bool has_nlopt() {
#ifdef SKINFRAME_HAS_NLOPT
  return true;
#else
  return false;
#endif
}

#ifdef SKINFRAME_HAS_NLOPT
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kNorm = 40;
constexpr double kTolerance = 1e-7;  // relative, of the volume
constexpr double kShift = 1e-12;     // of the largest diagonal
constexpr int kMostEvaluations = 2000;

// Displacements as a function of areas, with an adjoint.
class Nested {
 public:
  explicit Nested(const FrameProblem& problem)
      : problem_(problem), springs_(strut_springs(problem.element, problem.material)) {
    const Frame& frame = problem.frame;
    rows_ = 3 * static_cast<int>(frame.nodes_mm.size());
    for (const Strut& strut : frame.struts) {
      lengths_.push_back(frame.length_mm(strut));
      stiffness_.push_back(strut_stiffness(springs_, frame.nodes_mm[strut.b] - frame.nodes_mm[strut.a]));
    }
  }

  int evaluations() const { return evaluations_; }
  double length(std::size_t strut) const { return lengths_[strut]; }

  // p-norm of |d_i|^2 over limit^2, minus one; its gradient when not empty.
  double limit(int load_case, const std::vector<double>& areas, std::vector<double>& gradient) {
    update(areas);
    const VectorXd& d = displacements_[load_case];
    const double squared = *problem_.displacement_limit_mm * *problem_.displacement_limit_mm;
    VectorXd share(rows_ / 3);
    for (int i = 0; i < share.size(); ++i) share[i] = d.segment<3>(3 * i).squaredNorm() / squared;
    const double largest = std::max(share.maxCoeff(), 1e-300);
    double sum = 0;
    for (int i = 0; i < share.size(); ++i) sum += std::pow(share[i] / largest, kNorm);
    if (!gradient.empty()) {
      VectorXd pull(rows_);
      for (int i = 0; i < share.size(); ++i)
        pull.segment<3>(3 * i) = 2 / squared * std::pow(sum, 1 / kNorm - 1) *
                                 std::pow(share[i] / largest, kNorm - 1) * d.segment<3>(3 * i);
      clear_fixed(pull);
      const VectorXd adjoint = factor_.solve(pull);
      const bool gravity = problem_.load_cases[load_case].gravity;
      for (std::size_t j = 0; j < areas.size(); ++j) {
        const Strut& strut = problem_.frame.struts[j];
        const Vector3d stretch = d.segment<3>(3 * strut.b) - d.segment<3>(3 * strut.a);
        const Vector3d other = adjoint.segment<3>(3 * strut.b) - adjoint.segment<3>(3 * strut.a);
        gradient[j] = -other.dot(stiffness_[j] * stretch);
        if (gravity)
          gradient[j] -=
              springs_.half_weight * lengths_[j] * (adjoint[3 * strut.a + 2] + adjoint[3 * strut.b + 2]);
      }
    }
    return largest * std::pow(sum, 1 / kNorm) - 1;
  }

 private:
  void clear_fixed(VectorXd& v) const {
    for (int i = 0; i < rows_; ++i)
      if (problem_.fixed[i / 3][i % 3]) v[i] = 0;
  }

  void update(const std::vector<double>& areas) {
    if (areas == areas_) return;
    areas_ = areas;
    ++evaluations_;
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(21 * areas.size() + rows_);
    double largest = 0;
    for (std::size_t j = 0; j < areas.size(); ++j) {
      const Strut& strut = problem_.frame.struts[j];
      const Matrix3d block = areas[j] * stiffness_[j];
      largest = std::max(largest, block.diagonal().maxCoeff());
      for (const int p : {strut.a, strut.b})
        for (const int q : {strut.a, strut.b})
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
              if (3 * p + r >= 3 * q + c && !problem_.fixed[p][r] && !problem_.fixed[q][c])
                entries.emplace_back(3 * p + r, 3 * q + c, (p == q ? 1 : -1) * block(r, c));
    }
    for (int i = 0; i < rows_; ++i)
      entries.emplace_back(i, i, problem_.fixed[i / 3][i % 3] ? largest : kShift * largest);
    Eigen::SparseMatrix<double> matrix(rows_, rows_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (evaluations_ == 1) factor_.analyzePattern(matrix);
    factor_.factorize(matrix);
    displacements_.clear();
    for (std::size_t k = 0; k < problem_.load_cases.size(); ++k) {
      const NodeVectors loads = nodal_loads_n(problem_, areas, static_cast<int>(k));
      VectorXd force(rows_);
      for (int i = 0; i < rows_; ++i) force[i] = loads[i / 3][i % 3];
      clear_fixed(force);
      displacements_.push_back(factor_.solve(force));
    }
  }

  const FrameProblem& problem_;
  StrutSprings springs_;
  int rows_ = 0, evaluations_ = 0;
  std::vector<double> lengths_, areas_;
  std::vector<Matrix3d> stiffness_;  // of a unit area
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> factor_;
  std::vector<VectorXd> displacements_;  // one a case
};

struct LimitOfCase {
  Nested* nested;
  int load_case;
};

double volume(const std::vector<double>& areas, std::vector<double>& gradient, void* data) {
  const auto& nested = *static_cast<const Nested*>(data);
  double total = 0, scale = 0;
  for (std::size_t j = 0; j < areas.size(); ++j)
    scale += nested.length(j) / static_cast<double>(areas.size());
  for (std::size_t j = 0; j < areas.size(); ++j) {
    total += areas[j] * nested.length(j) / scale;
    if (!gradient.empty()) gradient[j] = nested.length(j) / scale;
  }
  return total;
}

double limit_of_case(const std::vector<double>& areas, std::vector<double>& gradient, void* data) {
  const auto& which = *static_cast<const LimitOfCase*>(data);
  return which.nested->limit(which.load_case, areas, gradient);
}

std::string words(nlopt::result ending) {
  switch (ending) {
    case nlopt::SUCCESS:
    case nlopt::FTOL_REACHED:
    case nlopt::XTOL_REACHED:
    case nlopt::STOPVAL_REACHED:
      return "converged";
    case nlopt::MAXEVAL_REACHED:
      return "evaluation limit";
    case nlopt::MAXTIME_REACHED:
      return "time limit";
    default:
      return "NLopt gave up";
  }
}

}  // namespace
#endif

NestedMma nested_mma(const FrameProblem& problem, double max_seconds) {
  const auto start = uniform_frame(problem);
  NestedMma result;
  if (!start) {
    result.ending = start.error().message;
    return result;
  }
  result.areas_mm2 = areas_of(start->radii_mm);
#ifdef SKINFRAME_HAS_NLOPT
  if (!problem.displacement_limit_mm) {
    result.ending = "no displacement limit";
    return result;
  }
  Nested nested(problem);
  nlopt::opt mma(nlopt::LD_MMA, static_cast<unsigned>(result.areas_mm2.size()));
  std::vector<double> lower, upper;
  for (std::size_t j = 0; j < result.areas_mm2.size(); ++j) {
    const AreaBounds bounds = area_bounds(problem, static_cast<int>(j));
    lower.push_back(bounds.lower_mm2);
    upper.push_back(bounds.upper_mm2);
    result.areas_mm2[j] = std::clamp(result.areas_mm2[j], lower[j], upper[j]);
  }
  mma.set_lower_bounds(lower);
  mma.set_upper_bounds(upper);
  mma.set_min_objective(volume, &nested);
  std::vector<LimitOfCase> limits;
  for (int k = 0; k < static_cast<int>(problem.load_cases.size()); ++k) limits.push_back({&nested, k});
  for (LimitOfCase& limit : limits) mma.add_inequality_constraint(limit_of_case, &limit, 1e-6);
  mma.set_ftol_rel(kTolerance);
  mma.set_maxeval(kMostEvaluations);
  mma.set_maxtime(max_seconds);
  try {
    double least = 0;
    result.ending = words(mma.optimize(result.areas_mm2, least));
  } catch (const std::exception& e) {  // NLopt's, for rounding and the like; what it has reached is kept
    result.ending = e.what();
  }
  result.evaluations = nested.evaluations();
#else
  (void)max_seconds;
  result.ending = "NLopt is absent";
#endif
  return result;
}

}  // namespace skinframe::bench
