// SPDX-License-Identifier: GPL-3.0-or-later
// A derivative against central differences: the error has to fall with the square of the step, and to little.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>

namespace skinframe::test {

inline void expect_derivative(const std::function<Eigen::MatrixXd(double)>& at,
                              const Eigen::MatrixXd& derivative, double step) {
  const auto error = [&](double h) {
    return ((at(h) - at(-h)) / (2 * h) - derivative).cwiseAbs().maxCoeff();
  };
  const double scale = std::max(derivative.cwiseAbs().maxCoeff(), at(0).cwiseAbs().maxCoeff() * 1e-3);
  const double coarse = error(step), fine = error(step / 4);
  if (coarse < 1e-9 * scale) return;  // exact but for rounding: the function is quadratic at most
  EXPECT_NEAR(std::log(coarse / fine) / std::log(4), 2, 0.15);
  EXPECT_LT(fine, 1e-3 * scale);
}

}  // namespace skinframe::test
