// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/cvt_energy.h"

#include <ceres/ceres.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "worker/frame/point_tree.h"
#include "worker/run/result.h"

namespace skinframe {
namespace {

constexpr double kEnergyTolerance = 1e-6;  // relative fall in one step at which the iteration ends
constexpr int kRank = 7;                   // pairs that L-BFGS keeps, as in Liu et al.

// The sites that move are the unknowns, three each. Lengths are counted in units of the problem's own, so
// that the first step of the line search is of the right size.
class CvtFunction final : public ceres::FirstOrderFunction {
 public:
  CvtFunction(const WeightedSamples& samples, const std::vector<char>& held,
              const std::vector<Eigen::Vector3d>& sites, int threads)
      : samples_(samples), sites_(sites), threads_(threads) {
    for (std::size_t i = 0; i < sites.size(); ++i)
      if (!held[i]) movable_.push_back(i);
    double weight = 0.0;
    for (const double w : samples.weights) weight += w;
    scale_ = static_cast<double>(sites.size()) / std::max(weight, 1e-300);
  }
  int NumParameters() const override { return static_cast<int>(3 * movable_.size()); }
  bool Evaluate(const double* x, double* cost, double* slope) const override {
    std::vector<Eigen::Vector3d> sites = moved(x), gradient;
    *cost = scale_ * cvt_energy(samples_, sites, threads_, slope != nullptr ? &gradient : nullptr);
    if (slope != nullptr)
      for (std::size_t k = 0; k < movable_.size(); ++k)
        Eigen::Map<Eigen::Vector3d>(slope + 3 * k) = scale_ * gradient[movable_[k]];
    return true;
  }
  std::vector<double> start() const {
    std::vector<double> x(3 * movable_.size());
    for (std::size_t k = 0; k < movable_.size(); ++k)
      Eigen::Map<Eigen::Vector3d>(x.data() + 3 * k) = sites_[movable_[k]];
    return x;
  }
  std::vector<Eigen::Vector3d> moved(const double* x) const {
    std::vector<Eigen::Vector3d> sites = sites_;
    for (std::size_t k = 0; k < movable_.size(); ++k)
      sites[movable_[k]] = Eigen::Map<const Eigen::Vector3d>(x + 3 * k);
    return sites;
  }

 private:
  const WeightedSamples& samples_;
  std::vector<Eigen::Vector3d> sites_;
  std::vector<std::size_t> movable_;
  int threads_;
  double scale_ = 1.0;
};

class StopWhenAsked final : public ceres::IterationCallback {
 public:
  explicit StopWhenAsked(const RunContext& context) : context_(context) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return context_.cancelled() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const RunContext& context_;
};

}  // namespace

double cvt_energy(const WeightedSamples& samples, const std::vector<Eigen::Vector3d>& sites, int threads,
                  std::vector<Eigen::Vector3d>* gradient) {
  SKINFRAME_CHECK(!sites.empty() && samples.points.size() == samples.weights.size());
  const PointTree tree(sites);
  std::vector<int> owner(samples.points.size());
  tbb::task_arena arena(std::max(1, threads));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, owner.size(), 1024), [&](const auto& range) {
      int near = 0;  // the sample before has it near
      for (std::size_t v = range.begin(); v < range.end(); ++v)
        near = owner[v] = tree.nearest_by_guess(samples.points[v], near);
    });
  });
  // Added up in order: the same sum at any thread count.
  if (gradient != nullptr) gradient->assign(sites.size(), Eigen::Vector3d::Zero());
  double energy = 0.0;
  for (std::size_t v = 0; v < owner.size(); ++v) {
    const Eigen::Vector3d off = sites[owner[v]] - samples.points[v];
    energy += samples.weights[v] * off.squaredNorm();
    if (gradient != nullptr) (*gradient)[owner[v]] += 2.0 * samples.weights[v] * off;
  }
  return energy;
}

void minimise_cvt(const WeightedSamples& samples, const std::vector<char>& held, int iterations,
                  const RunContext& context, std::vector<Eigen::Vector3d>& sites) {
  SKINFRAME_CHECK(held.size() == sites.size());
  if (sites.empty() || samples.points.empty() || iterations < 1) return;
  auto* function = new CvtFunction(samples, held, sites, context.threads);
  const ceres::GradientProblem problem(function);  // takes the function
  if (function->NumParameters() == 0) return;
  StopWhenAsked stop(context);
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::LBFGS;
  options.max_lbfgs_rank = kRank;
  options.max_num_iterations = iterations;
  options.function_tolerance = kEnergyTolerance;
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&stop);
  ceres::GradientProblemSolver::Summary summary;
  std::vector<double> x = function->start();
  ceres::Solve(options, problem, x.data(), &summary);
  if (summary.IsSolutionUsable() && summary.final_cost <= summary.initial_cost)
    sites = function->moved(x.data());
}

}  // namespace skinframe
