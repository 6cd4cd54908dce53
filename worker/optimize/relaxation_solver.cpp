// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/relaxation_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "worker/optimize/frame_cholesky.h"

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStepShare = 0.99;    // of the way to the nearest bound
constexpr double kStartShare = 0.05;   // a start keeps this share of its area, or of the range, to a bound
constexpr double kStartBarrier = 0.1;  // products of areas and their duals
// The fields count as displacements of the areas when their forces miss by this share of the largest load.
constexpr double kNearlyInEquilibrium = 1e-3;
constexpr double kLeastStep = 1e-6;      // below it nothing moves any more
constexpr double kLeastCentring = 0.02;  // of the mean complementarity

class Solver {
 public:
  Solver(const Relaxation& p, const RelaxationOptions& options)
      : p_(p),
        options_(options),
        cases_(p.case_count()),
        terms_(p.term_count()),
        struts_(p.strut_count()),
        cholesky_(p.struts, p.fixed, std::max(1, p.case_count())) {}

  RelaxationOutcome run(const VectorXd& areas, const VectorXd& displacements) {
    start(areas, displacements);
    RelaxationOutcome outcome;
    for (; outcome.iterations < options_.max_iterations; ++outcome.iterations) {
      linearise();
      if (options_.each(point_)) return outcome;
      if (options_.least_excess && excess_.size() > 0 && excess_.maxCoeff() <= 0 &&
          worst_force() <= kNearlyInEquilibrium) {
        outcome.feasible = true;
        return outcome;
      }
      if (worst_residual() <= options_.tolerance && mean_product() <= options_.tolerance) {
        outcome.converged = true;
        return outcome;
      }
      if (!assemble()) return outcome;
      const double mean = mean_product();
      direction(0);
      const double affine = product_after(step_length(1.0)) / mean;
      direction(std::max(affine * affine * affine, kLeastCentring) * mean);
      const double step = step_length(kStepShare);
      if (!(step > kLeastStep)) return outcome;
      advance(step);
    }
    return outcome;
  }

 private:
  auto at(const VectorXd& full, int node, int k) const { return full.segment<3>(3 * (cases_ * node + k)); }

  void start(const VectorXd& areas, const VectorXd& displacements) {
    point_.areas = areas;
    below_dual_ = above_dual_ = VectorXd::Zero(struts_);
    for (int j = 0; j < struts_; ++j) {
      if (p_.area_is_given(j)) {
        point_.areas[j] = p_.lower[j];
        continue;
      }
      const double range = p_.upper[j] - p_.lower[j];
      const double keep = kStartShare * std::min(range, std::max(areas[j], 1.0));
      point_.areas[j] = std::clamp(areas[j], p_.lower[j] + keep, p_.upper[j] - keep);
    }
    displacements_ = displacements;
    start_multipliers();
    point_.fields = displacements_;
    for (int i = 0; i < static_cast<int>(p_.fixed.size()); ++i)
      for (int k = 0; k < cases_; ++k) point_.fields.segment<3>(3 * (cases_ * i + k)) *= case_weight(k);
    linearise();
    double barrier = kStartBarrier;
    if (options_.least_excess) {
      excess_bound_ = std::max(2 * excess_.maxCoeff(), 1e-2 * struts_);
      excess_slack_ = 0.5;
      barrier *= excess_bound_ / struts_;
    }
    for (int j = 0; j < struts_; ++j) {
      if (p_.area_is_given(j)) continue;
      below_dual_[j] = barrier / (point_.areas[j] - p_.lower[j]);
      above_dual_[j] = barrier / (p_.upper[j] - point_.areas[j]);
    }
    slacks_.resize(terms_);
    for (int c = 0; c < terms_; ++c) slacks_[c] = std::max(excess_bound_ - excess_[c], 1e-2 * struts_);
  }

  // So that the cost's gradient is met on average where areas stand above their lower bounds.
  void start_multipliers() {
    point_.multipliers = VectorXd::Constant(terms_, 0.5 / std::max(terms_, 1));
    if (options_.least_excess) return;
    int energies = 0;
    for (const RelaxedTerm& term : p_.terms) energies += term.kind != TermKind::kBalance;
    if (energies == 0) return;
    for (int c = 0; c < terms_; ++c)
      point_.multipliers[c] = p_.terms[c].kind == TermKind::kBalance ? 1e-2 : 1.0 / energies;
    SaddlePoint trial = point_;
    trial.fields = displacements_;
    for (int i = 0; i < static_cast<int>(p_.fixed.size()); ++i)
      for (int k = 0; k < cases_; ++k) trial.fields.segment<3>(3 * (cases_ * i + k)) *= case_weight(k);
    const VectorXd room = point_.areas - (1 - kStartShare) * p_.lower;
    const double falls = -dual_form(p_, trial).slope.dot(room);
    if (falls > 0) point_.multipliers *= p_.cost.dot(room) / falls;
  }

  double case_weight(int k) const {
    double weight = 0;
    for (int c = 0; c < terms_; ++c)
      if (p_.terms[c].load_case == k) weight += point_.multipliers[c];
    return weight;
  }

  // Everything that depends on the point alone.
  void linearise() {
    weights_.resize(cases_);
    for (int k = 0; k < cases_; ++k) weights_[k] = case_weight(k);
    displacements_ = point_.fields;
    for (int i = 0; i < static_cast<int>(p_.fixed.size()); ++i)
      for (int k = 0; k < cases_; ++k) displacements_.segment<3>(3 * (cases_ * i + k)) /= weights_[k];
    pulls_.assign(cases_, Eigen::Matrix3Xd(3, struts_));
    energies_.resize(struts_, cases_);
    forces_ = p_.external;
    internal_ = VectorXd::Zero(forces_.size());
    for (int j = 0; j < struts_; ++j) {
      const auto [a, b] = p_.struts[j];
      for (int k = 0; k < cases_; ++k) {
        const Vector3d delta = at(displacements_, b, k) - at(displacements_, a, k);
        const Vector3d pull = p_.stiffness[j] * delta;
        pulls_[k].col(j) = pull;
        energies_(j, k) = delta.dot(pull);
        const double weight = p_.gravity[k] * p_.half_weight[j] * point_.areas[j];
        forces_[3 * (cases_ * a + k) + 2] -= weight;
        forces_[3 * (cases_ * b + k) + 2] -= weight;
        internal_.segment<3>(3 * (cases_ * a + k)) -= point_.areas[j] * pull;
        internal_.segment<3>(3 * (cases_ * b + k)) += point_.areas[j] * pull;
      }
    }
    for (int i = 0; i < static_cast<int>(p_.fixed.size()); ++i)
      for (int k = 0; k < cases_; ++k)
        for (int axis = 0; axis < 3; ++axis)
          if (p_.fixed[i][axis])
            forces_[3 * (cases_ * i + k) + axis] = internal_[3 * (cases_ * i + k) + axis] = 0;
    stored_ = energies_.transpose() * point_.areas;
    excess_.resize(terms_);
    for (int c = 0; c < terms_; ++c) {
      const RelaxedTerm& term = p_.terms[c];
      excess_[c] = term.constant + term.slope.dot(point_.areas);
      if (term.load_case >= 0) excess_[c] += stored_[term.load_case];
    }
    gradient_ = p_.cost + dual_form(p_, point_).slope;
  }

  double worst_force() const {
    return forces_.size() == 0 ? 0.0
                               : (forces_ - internal_).lpNorm<Eigen::Infinity>() /
                                     std::max(forces_.lpNorm<Eigen::Infinity>(), 1e-300);
  }

  double worst_residual() const {
    double worst = worst_force();
    for (int j = 0; j < struts_; ++j)
      if (!p_.area_is_given(j))
        worst = std::max(worst, std::abs(gradient_[j] - below_dual_[j] + above_dual_[j]));
    for (int c = 0; c < terms_; ++c)
      worst = std::max(worst, std::abs(excess_[c] + slacks_[c] - excess_bound_) / struts_);
    return worst;
  }

  double mean_product() const {
    double sum = slacks_.dot(point_.multipliers) + excess_bound_ * excess_slack_;
    int count = terms_ + (options_.least_excess ? 1 : 0);
    for (int j = 0; j < struts_; ++j) {
      if (p_.area_is_given(j)) continue;
      sum +=
          below_dual_[j] * (point_.areas[j] - p_.lower[j]) + above_dual_[j] * (p_.upper[j] - point_.areas[j]);
      count += 2;
    }
    return sum / std::max(count, 1);
  }

  // The derivative of the gradient in A_j by w, at the strut's two ends.
  VectorXd coupling(int j) const {
    VectorXd column(6 * cases_);
    for (int k = 0; k < cases_; ++k) {
      const Vector3d weight(0, 0, -p_.gravity[k] * p_.half_weight[j]);
      column.segment<3>(3 * k) = 2 * (weight + pulls_[k].col(j));
      column.segment<3>(3 * (cases_ + k)) = 2 * (weight - pulls_[k].col(j));
    }
    return column;
  }
  double term_coupling(int c, int j) const {
    const int k = p_.terms[c].load_case;
    return p_.terms[c].slope[j] + (k >= 0 ? energies_(j, k) : 0.0);
  }

  template <class Column>
  void scatter(int j, const VectorXd& column, double factor, Column&& full) const {
    full.segment(3 * cases_ * p_.struts[j].first, 3 * cases_) += factor * column.head(3 * cases_);
    full.segment(3 * cases_ * p_.struts[j].second, 3 * cases_) += factor * column.tail(3 * cases_);
  }
  double gather(int j, const VectorXd& column, const VectorXd& full) const {
    return column.head(3 * cases_).dot(full.segment(3 * cases_ * p_.struts[j].first, 3 * cases_)) +
           column.tail(3 * cases_).dot(full.segment(3 * cases_ * p_.struts[j].second, 3 * cases_));
  }

  bool assemble() {
    flexibility_ = VectorXd::Zero(struts_);
    for (int j = 0; j < struts_; ++j)
      if (!p_.area_is_given(j))
        flexibility_[j] = 1 / (below_dual_[j] / (point_.areas[j] - p_.lower[j]) +
                               above_dual_[j] / (p_.upper[j] - point_.areas[j]));
    cholesky_.clear();
    border_ = MatrixXd::Zero(p_.external.size(), terms_);
    corner_ = MatrixXd::Zero(terms_, terms_);
    MatrixXd block(6 * cases_, 6 * cases_);
    VectorXd terms(terms_);
    for (int j = 0; j < struts_; ++j) {
      const VectorXd column = coupling(j);
      block.noalias() = flexibility_[j] * column * column.transpose();
      for (int k = 0; k < cases_; ++k) {
        const Eigen::Matrix3d stiffness = 2 * point_.areas[j] / weights_[k] * p_.stiffness[j];
        const int a = 3 * k, b = 3 * (cases_ + k);
        block.block<3, 3>(a, a) += stiffness;
        block.block<3, 3>(b, b) += stiffness;
        block.block<3, 3>(a, b) -= stiffness;
        block.block<3, 3>(b, a) -= stiffness;
      }
      if (cases_ > 0) cholesky_.add(j, block);
      for (int c = 0; c < terms_; ++c) {
        terms[c] = term_coupling(c, j);
        if (cases_ > 0) scatter(j, column, flexibility_[j] * terms[c], border_.col(c));
      }
      corner_.noalias() += flexibility_[j] * terms * terms.transpose();
    }
    for (int c = 0; c < terms_; ++c) {
      const int k = p_.terms[c].load_case;
      corner_(c, c) += slacks_[c] / point_.multipliers[c];
      if (k < 0) continue;
      for (int i = 0; i < static_cast<int>(p_.fixed.size()); ++i)
        border_.col(c).segment<3>(3 * (cases_ * i + k)) -= 2 / weights_[k] * at(internal_, i, k);
      for (int d = 0; d < terms_; ++d)
        if (p_.terms[d].load_case == k) corner_(c, d) += 2 * stored_[k] / weights_[k];
    }
    if (options_.least_excess) corner_ += excess_bound_ / excess_slack_ * MatrixXd::Ones(terms_, terms_);
    for (int i = 0; cases_ > 0 && i < static_cast<int>(p_.fixed.size()); ++i)
      for (int row = 0; row < 3 * cases_; ++row)
        if (p_.fixed[i][row % 3]) border_.row(3 * cases_ * i + row).setZero();
    if (cases_ > 0 && !cholesky_.factorise()) return false;
    solved_border_ = border_;
    for (int c = 0; cases_ > 0 && c < terms_; ++c) solved_border_.col(c) = cholesky_.solve(border_.col(c));
    schur_.compute(corner_ - border_.transpose() * solved_border_);
    return schur_.info() == Eigen::Success;
  }

  // The Newton step towards complementarity `barrier`.
  void direction(double barrier) {
    VectorXd force = 2 * (forces_ - internal_), terms = excess_ + barrier * point_.multipliers.cwiseInverse();
    if (options_.least_excess) terms.array() -= barrier / excess_slack_;
    VectorXd residual = VectorXd::Zero(struts_);
    for (int j = 0; j < struts_; ++j) {
      if (p_.area_is_given(j)) continue;
      residual[j] = gradient_[j] - barrier / (point_.areas[j] - p_.lower[j]) +
                    barrier / (p_.upper[j] - point_.areas[j]);
      if (cases_ > 0) scatter(j, coupling(j), -flexibility_[j] * residual[j], force);
      for (int c = 0; c < terms_; ++c) terms[c] -= term_coupling(c, j) * flexibility_[j] * residual[j];
    }
    for (int i = 0; cases_ > 0 && i < static_cast<int>(p_.fixed.size()); ++i)
      for (int row = 0; row < 3 * cases_; ++row)
        if (p_.fixed[i][row % 3]) force[3 * cases_ * i + row] = 0;
    const VectorXd loose = cases_ > 0 ? cholesky_.solve(force) : force;
    step_.multipliers = schur_.solve(terms - border_.transpose() * loose);
    step_.fields = loose - solved_border_ * step_.multipliers;

    step_.areas = below_step_ = above_step_ = VectorXd::Zero(struts_);
    for (int j = 0; j < struts_; ++j) {
      if (p_.area_is_given(j)) continue;
      double pull = cases_ > 0 ? gather(j, coupling(j), step_.fields) : 0.0;
      for (int c = 0; c < terms_; ++c) pull += term_coupling(c, j) * step_.multipliers[c];
      step_.areas[j] = -flexibility_[j] * (residual[j] + pull);
      const double below = point_.areas[j] - p_.lower[j], above = p_.upper[j] - point_.areas[j];
      below_step_[j] = (barrier - below_dual_[j] * step_.areas[j]) / below - below_dual_[j];
      above_step_[j] = (barrier + above_dual_[j] * step_.areas[j]) / above - above_dual_[j];
    }
    slack_step_ = (barrier - slacks_.array() * step_.multipliers.array()) / point_.multipliers.array() -
                  slacks_.array();
    excess_step_ = excess_slack_step_ = 0;
    if (options_.least_excess) {
      excess_slack_step_ = -step_.multipliers.sum();
      excess_step_ = (barrier - excess_bound_ * excess_slack_step_) / excess_slack_ - excess_bound_;
    }
  }

  // The longest step that keeps every positive quantity at (1 - share) of itself, at most 1.
  double step_length(double share) const {
    double step = 1;
    const auto limit = [&](double value, double change) {
      if (change < 0) step = std::min(step, -share * value / change);
    };
    for (int j = 0; j < struts_; ++j) {
      if (p_.area_is_given(j)) continue;
      limit(point_.areas[j] - p_.lower[j], step_.areas[j]);
      limit(p_.upper[j] - point_.areas[j], -step_.areas[j]);
      limit(below_dual_[j], below_step_[j]);
      limit(above_dual_[j], above_step_[j]);
    }
    for (int c = 0; c < terms_; ++c) {
      limit(point_.multipliers[c], step_.multipliers[c]);
      limit(slacks_[c], slack_step_[c]);
    }
    if (options_.least_excess) {
      limit(excess_bound_, excess_step_);
      limit(excess_slack_, excess_slack_step_);
    }
    return step;
  }

  double product_after(double step) const {
    double sum = (slacks_ + step * slack_step_).dot(point_.multipliers + step * step_.multipliers) +
                 (excess_bound_ + step * excess_step_) * (excess_slack_ + step * excess_slack_step_);
    int count = terms_ + (options_.least_excess ? 1 : 0);
    for (int j = 0; j < struts_; ++j) {
      if (p_.area_is_given(j)) continue;
      const double area = point_.areas[j] + step * step_.areas[j];
      sum += (below_dual_[j] + step * below_step_[j]) * (area - p_.lower[j]) +
             (above_dual_[j] + step * above_step_[j]) * (p_.upper[j] - area);
      count += 2;
    }
    return sum / std::max(count, 1);
  }

  void advance(double step) {
    point_.areas += step * step_.areas;
    point_.multipliers += step * step_.multipliers;
    // To first order the fields' own step, but taken in y = w / u: where a load case does not bind, u falls
    // to nothing within a few steps, and a w that does not fall with it would be a huge displacement.
    for (int k = 0; k < cases_; ++k) {
      const double weight = case_weight(k), change = (weight - weights_[k]) / step;
      for (int i = 0; i < static_cast<int>(p_.fixed.size()); ++i) {
        const int at_node = 3 * (cases_ * i + k);
        const Vector3d y = displacements_.segment<3>(at_node);
        const Vector3d dy = (step_.fields.segment<3>(at_node) - change * y) / weights_[k];
        point_.fields.segment<3>(at_node) = weight * (y + step * dy);
      }
    }
    below_dual_ += step * below_step_;
    above_dual_ += step * above_step_;
    slacks_ += step * slack_step_;
    excess_bound_ += step * excess_step_;
    excess_slack_ += step * excess_slack_step_;
  }

  const Relaxation& p_;
  const RelaxationOptions& options_;
  const int cases_, terms_, struts_;
  FrameCholesky cholesky_;

  SaddlePoint point_, step_;
  VectorXd below_dual_, above_dual_, below_step_, above_step_;
  VectorXd slacks_, slack_step_;                // of the terms: excess + slack = excess_bound_
  double excess_bound_ = 0, excess_slack_ = 0;  // least_excess: its value, and 1 - sum of multipliers
  double excess_step_ = 0, excess_slack_step_ = 0;

  // Of the present point.
  VectorXd displacements_, weights_, forces_, internal_, stored_, excess_, gradient_, flexibility_;
  std::vector<Eigen::Matrix3Xd> pulls_;  // B delta of each strut, one a load case
  MatrixXd energies_;                    // delta^T B delta: struts x load cases
  MatrixXd border_, solved_border_, corner_;
  Eigen::LDLT<MatrixXd> schur_;
};

}  // namespace

RelaxationOutcome solve_relaxation(const Relaxation& relaxation, const VectorXd& start_areas,
                                   const VectorXd& start_displacements, const RelaxationOptions& options) {
  return Solver(relaxation, options).run(start_areas, start_displacements);
}

}  // namespace skinframe
