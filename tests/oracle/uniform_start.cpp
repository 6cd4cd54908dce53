// SPDX-License-Identifier: Apache-2.0
#include "tests/oracle/uniform_start.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <stdexcept>

namespace oracle {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMostSolves = 12;
constexpr double kRoom = 1.02;       // above what the secant says
constexpr double kGoodEnough = 0.9;  // demand over limit, of a start that keeps the limits
constexpr double kShift = 1e-10;     // of the largest diagonal: mechanisms leave the stiffness singular

Start at(const FrameFile& frame, double area) {
  const int dof = 3 * static_cast<int>(frame.nodes.size());
  Start start;
  std::vector<Eigen::Triplet<double>> entries;
  double largest = 0;
  for (const FrameStrut& strut : frame.struts) {
    start.areas.push_back(std::clamp(area, strut.least_area, strut.most_area));
    const Matrix3d nn = strut.direction * strut.direction.transpose();
    const Matrix3d block =
        start.areas.back() / strut.length * (frame.tension * nn + frame.shear * (Matrix3d::Identity() - nn));
    largest = std::max(largest, block.diagonal().maxCoeff());
    for (const int p : {strut.a, strut.b})
      for (const int q : {strut.a, strut.b})
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c)
            if (!frame.fixed[p][r] && !frame.fixed[q][c])
              entries.emplace_back(3 * p + r, 3 * q + c, (p == q ? 1 : -1) * block(r, c));
  }
  for (int i = 0; i < dof; ++i)
    entries.emplace_back(i, i, frame.fixed[i / 3][i % 3] ? largest : kShift * largest);
  Eigen::SparseMatrix<double> stiffness(dof, dof);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor(stiffness);
  if (factor.info() != Eigen::Success)
    throw std::runtime_error("the stiffness of the start cannot be factorised");
  for (const FrameCase& load : frame.cases) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(dof);
    for (std::size_t i = 0; i < frame.nodes.size(); ++i) force.segment<3>(3 * i) = load.force[i];
    for (std::size_t j = 0; load.gravity && j < frame.struts.size(); ++j)
      for (const int end : {frame.struts[j].a, frame.struts[j].b})
        force[3 * end + 2] -= start.areas[j] * frame.struts[j].length * frame.weight / 2;
    for (int i = 0; i < dof; ++i)
      if (frame.fixed[i / 3][i % 3]) force[i] = 0;
    const Eigen::VectorXd d = factor.solve(force);
    start.displacements.emplace_back();
    for (std::size_t i = 0; i < frame.nodes.size(); ++i)
      start.displacements.back().push_back(d.segment<3>(3 * i));
  }
  return start;
}

// The largest demand over limit, of displacements and strains.
double demand(const FrameFile& frame, const Start& start) {
  double worst = 0;
  for (const auto& d : start.displacements) {
    if (frame.displacement_limit)
      for (const Vector3d& one : d) worst = std::max(worst, one.norm() / *frame.displacement_limit);
    for (const FrameStrut& strut : frame.struts) {
      const Vector3d stretch = d[strut.b] - d[strut.a];
      const double along = strut.direction.dot(stretch);
      const double aside = (stretch - along * strut.direction).norm();
      if (frame.tensile_strength)
        worst = std::max(worst, std::abs(along) / strut.length * frame.tension / *frame.tensile_strength);
      if (frame.shear_strength)
        worst = std::max(worst, aside / strut.length * frame.shear / *frame.shear_strength);
    }
  }
  return worst;
}

}  // namespace

Start uniform_start(const FrameFile& frame) {
  double least = frame.struts.front().least_area, most = frame.struts.front().most_area;
  for (const FrameStrut& strut : frame.struts) {
    least = std::min(least, strut.least_area);
    most = std::max(most, strut.most_area);
  }
  double area = std::max(least, 0.05 * most);
  Start best = at(frame, area);
  double best_demand = demand(frame, best);
  for (int solve = 0; solve < kMostSolves; ++solve) {
    if (best_demand <= 1 && (best_demand >= kGoodEnough || area <= least)) break;
    // Under external forces alone, displacements go as one over the area.
    const double next = std::clamp(area * kRoom * best_demand, std::max(least, 1e-4 * most), most);
    if (next == area) break;
    area = next;
    best = at(frame, area);
    best_demand = demand(frame, best);
  }
  return best;
}

}  // namespace oracle
