// SPDX-License-Identifier: GPL-3.0-or-later
// A symmetric positive definite matrix with one dense block of 3 x cases axes a node and a coupling along
// each strut, summed strut by strut and factorised by CHOLMOD. The pattern is analysed once a frame.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace skinframe {

class FrameCholesky {
 public:
  FrameCholesky(const std::vector<std::pair<int, int>>& struts, const std::vector<std::array<bool, 3>>& fixed,
                int cases);
  ~FrameCholesky();
  FrameCholesky(FrameCholesky&&) noexcept;

  // Vectors stand full: entry 3 (cases * node + case) + axis; fixed axes are ignored and come out zero.
  int size() const;
  void clear();
  // Rows and columns of the block: the axes of end a (case after case), then those of end b.
  void add(int strut, const Eigen::MatrixXd& block);
  bool factorise();  // false: not positive definite
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skinframe
