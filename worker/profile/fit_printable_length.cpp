// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/profile/fit_printable_length.h"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

constexpr double kLeastLengthMm = 0.001;  // of the flattest strut: a curve is positive

// Half the sum of squared residuals as a quadratic in x = [s_0 .. s_(n-2), b - least]: x'Gx / 2 - h'x + rest.
struct Quadratic {
  Eigen::MatrixXd g;
  Eigen::VectorXd h;
  double rest = 0;

  double value(const Eigen::VectorXd& x) const { return 0.5 * x.dot(g * x) - h.dot(x) + rest; }
  Eigen::VectorXd gradient(const Eigen::VectorXd& x) const { return g * x - h; }
};

// The quadratic over x >= 0, as a smooth function of u with x = u^2.
class OverSquares final : public ceres::FirstOrderFunction {
 public:
  explicit OverSquares(const Quadratic& quadratic) : quadratic_(quadratic) {}
  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const Eigen::Map<const Eigen::VectorXd> u(parameters, NumParameters());
    const Eigen::VectorXd x = u.cwiseAbs2();
    *cost = quadratic_.value(x);
    if (gradient != nullptr)
      Eigen::Map<Eigen::VectorXd>(gradient, NumParameters()) = 2 * u.cwiseProduct(quadratic_.gradient(x));
    return true;
  }
  int NumParameters() const override { return static_cast<int>(quadratic_.h.size()); }

 private:
  const Quadratic& quadratic_;
};

// Whether x is the minimum over x >= 0: no gradient where x is free, none that pulls inwards where it is 0.
bool is_minimum(const Quadratic& quadratic, const Eigen::VectorXd& x, double tolerance) {
  const Eigen::VectorXd gradient = quadratic.gradient(x);
  for (Eigen::Index k = 0; k < x.size(); ++k)
    if (!(x[k] >= 0 && gradient[k] >= -tolerance && gradient[k] * x[k] <= tolerance)) return false;
  return true;
}

// The exact minimum with those at 0 that the search has put there, or near it; x itself where that is none.
Eigen::VectorXd polished(const Quadratic& quadratic, const Eigen::VectorXd& x) {
  const Eigen::VectorXd gradient = quadratic.gradient(x);
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < x.size(); ++k)
    if (x[k] > gradient[k]) free.push_back(k);
  Eigen::VectorXd exact = Eigen::VectorXd::Zero(x.size());
  const Eigen::MatrixXd g = quadratic.g(free, free);
  const Eigen::VectorXd h = quadratic.h(free);
  if (h.size() > 0) exact(free) = g.ldlt().solve(h).eval();
  return exact.minCoeff() >= 0 && quadratic.value(exact) <= quadratic.value(x) ? exact : x;
}

std::vector<double> choose_knots(const std::vector<CalibrationPoint>& points) {
  std::vector<double> angles;
  for (const CalibrationPoint& point : points) angles.push_back(point.angle_deg);
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  if (angles.size() <= static_cast<std::size_t>(kMostKnots)) return angles;
  std::vector<double> knots;
  for (int k = 0; k < kMostKnots; ++k)
    knots.push_back(angles[static_cast<std::size_t>(k) * (angles.size() - 1) / (kMostKnots - 1)]);
  return knots;
}

// p(angle) = b + the drops behind the angle: whole ones of the intervals that begin at it or flatter, and its
// share of the interval in which it lies.
Eigen::VectorXd row_at(double angle, const std::vector<double>& knots) {
  Eigen::VectorXd row(static_cast<Eigen::Index>(knots.size()));
  row[row.size() - 1] = 1;  // b
  for (std::size_t k = 0; k + 1 < knots.size(); ++k)
    row[static_cast<Eigen::Index>(k)] =
        std::clamp((knots[k + 1] - angle) / (knots[k + 1] - knots[k]), 0.0, 1.0);
  return row;
}

// In shares of the longest strut, so that tolerances mean the same for every printer.
Quadratic sum_of_squares(const std::vector<CalibrationPoint>& points, const std::vector<double>& knots,
                         double longest_mm) {
  const auto n = static_cast<Eigen::Index>(knots.size());
  Quadratic sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const CalibrationPoint& point : points) {
    const Eigen::VectorXd row = row_at(point.angle_deg, knots);
    const double measured = (point.length_mm - kLeastLengthMm) / longest_mm;
    sum.g += row * row.transpose();
    sum.h += measured * row;
    sum.rest += 0.5 * measured * measured;
  }
  return sum;
}

}  // namespace

Result<CalibrationFit> fit_printable_length(const std::vector<CalibrationPoint>& points) {
  const std::vector<double> knots = choose_knots(points);
  SKINFRAME_CHECK(knots.size() >= 2);
  double longest_mm = 0;
  for (const CalibrationPoint& point : points) longest_mm = std::max(longest_mm, point.length_mm);
  const Quadratic sum = sum_of_squares(points, knots, longest_mm);

  // From a straight line; no u may start at 0, where the gradient in u vanishes whatever that in x is.
  Eigen::VectorXd u =
      Eigen::VectorXd::Constant(sum.h.size(), std::sqrt(1.0 / static_cast<double>(knots.size())));
  ceres::GradientProblem problem(new OverSquares(sum));
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::LBFGS;
  options.max_num_iterations = 5000;
  options.function_tolerance = 0;
  options.gradient_tolerance = 1e-12 * static_cast<double>(points.size());
  options.parameter_tolerance = 0;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, u.data(), &summary);
  // The solver may end because steps no longer show in the cost; what counts is where it ended.
  const Eigen::VectorXd x = polished(sum, u.cwiseAbs2());
  if (!is_minimum(sum, x, 1e-8 * static_cast<double>(points.size())))
    return internal_error(fmt::format("the fit did not converge: {}", summary.message));
  const auto length_at = [&](double angle) {
    return kLeastLengthMm + longest_mm * row_at(angle, knots).dot(x);
  };

  CalibrationFit fit;
  for (const double knot : knots) {
    fit.points.push_back({knot, std::max(kLeastLengthMm, std::floor(length_at(knot) * 1000 + 1e-6) / 1000)});
  }
  double squares = 0;
  for (const CalibrationPoint& point : points) {
    fit.fitted_mm.push_back(length_at(point.angle_deg));
    const double residual = point.length_mm - fit.fitted_mm.back();
    squares += residual * residual;
    fit.largest_mm = std::max(fit.largest_mm, std::abs(residual));
  }
  fit.rms_mm = std::sqrt(squares / static_cast<double>(points.size()));
  return fit;
}

}  // namespace skinframe
