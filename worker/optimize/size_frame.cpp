// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/size_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "worker/optimize/uniform_start.h"

namespace skinframe {
namespace {

// The elastic program may stop once the limits hold with this much room, in t = utilisation^2, and with this
// primal error.
constexpr double kElasticEnough = 0.98;
constexpr double kElasticError = 1e-4;
// The least violation is told to four digits, and need not be known to more.
constexpr double kElasticRoughly = 100;
// t weighs as much as the whole volume: a smaller barrier to begin with leaves its duals far from central.
constexpr double kElasticBarrier = 1;
// A proof that also refutes limits this many times as wide says so.
constexpr double kWorthSaying = 1.001;
// The least violation of balance counts as none below this, mm.
constexpr double kBalanceToleranceMm = 1e-6;
// A hint is a start when it is at most this far from feasible.
constexpr double kHintUtilisation = 1.5;
constexpr double kNearBarrier = 1e-2;
// A sizing that misses the limits by less than this is thickened, this often at most and with this much room;
// it remains an optimum while its volume grows by no more than kOptimalRepair.
constexpr double kRepairableUtilisation = 1.01;
constexpr int kMostRepairs = 4;
constexpr double kRepairRoom = 1e-7;
constexpr double kOptimalRepair = 1e-4;

class Sizing {
 public:
  Sizing(const FrameProblem& problem, Session& session, SizingEffort effort)
      : problem_(problem), session_(session), effort_(effort), solver_(problem) {
    set_size_bounds(problem, bounds_);
  }

  SizedFrame run(const std::vector<double>& hint_mm2) {
    if (const SizedFrame least = presolve(); least.feasible()) return least;
    if (session_.cancelled()) return cancelled();
    if (const auto unbalanced = least_imbalance()) return *unbalanced;

    std::vector<double> start = hint_mm2;
    for (std::size_t j = 0; j < start.size(); ++j)
      start[j] = std::clamp(start[j], bounds_.lower_mm2[j], bounds_.upper_mm2[j]);
    if (start.empty() || utilisation(evaluated(start)) > kHintUtilisation) {
      UniformStart uniform = uniform_start(problem_, bounds_.lower_mm2, bounds_.upper_mm2, solver_);
      start = std::move(uniform.areas_mm2);
      if (uniform.utilisation > 1) {
        auto proof = certify_infeasible(problem_, certificate_request(start));
        if (session_.cancelled()) return cancelled();
        if (proof && effort_ == SizingEffort::kVerdict)
          return judged(at(Termination::kInfeasible, start, ""), std::move(proof));
        SizedFrame reached = least_utilisation(start, uniform.utilisation);
        if (reached.cancelled) return reached;
        if (!reached.feasible()) {
          if (!proof) proof = certify_infeasible(problem_, certificate_request(reached.areas_mm2));
          return judged(std::move(reached), std::move(proof));
        }
        start = reached.areas_mm2;
      }
    }
    if (session_.cancelled()) return cancelled();
    SizedFrame sized = minimise_volume(start, !hint_mm2.empty());
    if (sized.cancelled || sized.feasible() || balanced_mm2_.empty()) return sized;
    SizedFrame again = minimise_volume(balanced_mm2_, false);
    return again.cancelled || again.feasible() ? again : sized;
  }

 private:
  Evaluation evaluated(const std::vector<double>& areas_mm2) {
    return evaluate(problem_, radii_of(areas_mm2), solver_.solve(areas_mm2));
  }
  bool holds(const Evaluation& evaluation) const { return is_feasible(evaluation, session_.options()); }

  SizedFrame at(Termination reason, std::vector<double> areas_mm2, std::string detail) {
    SizedFrame sized;
    sized.reason = reason;
    sized.evaluation = evaluated(areas_mm2);
    sized.areas_mm2 = std::move(areas_mm2);
    sized.detail = std::move(detail);
    if (reason == Termination::kInfeasible)
      sized.violated_constraint =
          violated_constraint(sized.evaluation, session_.options().feasibility_tolerance);
    return sized;
  }
  CertificateRequest certificate_request(std::vector<double> near_mm2) const {
    return {{bounds_.lower_mm2, bounds_.upper_mm2},
            std::move(near_mm2),
            session_.options().feasibility_tolerance,
            [this] { return session_.cancelled(); }};
  }

  // The verdict on an infeasible frame, in words: proven or not, and how near it comes. Its detail so far
  // says how the search for it ended.
  SizedFrame judged(SizedFrame reached, std::optional<InfeasibilityCertificate> proof) {
    const std::string how = std::move(reached.detail);
    const double used = utilisation(reached.evaluation);
    reached.detail = reached.violated_constraint + " cannot be kept, ";
    reached.detail += proof ? "proven: no radii within their bounds keep the limits" : "not proven";
    if (proof && proof->proven_ratio > kWorthSaying)
      reached.detail += fmt::format(", nor {:.4g} times as wide ones", proof->proven_ratio);
    if (reached.violated_constraint != "balance" && std::isfinite(used))
      reached.detail += fmt::format("; best found: {:.4g} times the limit", used);
    if (!how.empty()) reached.detail += fmt::format(" ({})", how);
    reached.certificate = std::move(proof);
    return reached;
  }

  SizedFrame cancelled() {
    SizedFrame sized;
    sized.cancelled = true;
    return sized;
  }

  SizedFrame presolve() {
    SizedFrame least =
        at(Termination::kOptimal, bounds_.lower_mm2, "every strut at its lower bound keeps every limit");
    least.lower_bound_mm3 = least.volume_mm3();
    if (!holds(least.evaluation)) least.reason = Termination::kInfeasible;
    return least;
  }

  // The load cases as the interior point takes them: those of the greatest demand first.
  int critical_case(const std::vector<double>& areas_mm2) {
    const std::vector<CaseResponse> responses = solver_.solve(areas_mm2);
    int critical = 0;
    double worst = -1;
    for (std::size_t k = 0; k < responses.size(); ++k) {
      const double demand = demand_of(areas_mm2, responses, static_cast<int>(k));
      if (demand > worst) worst = demand, critical = static_cast<int>(k);
    }
    return critical;
  }

  double demand_of(const std::vector<double>& areas_mm2, const std::vector<CaseResponse>& responses,
                   int load_case) const {
    return utilisation(evaluate(problem_, radii_of(areas_mm2), {responses[load_case]}));
  }

  ProgramRequest request(const std::vector<int>& cases) const {
    ProgramRequest request = bounds_;
    request.cases = cases;
    return request;
  }

  // Calls solve(cases) with more and more of them until it returns areas that none of the others violates.
  template <class Solve>
  ProgramOutcome over_cases(const std::vector<double>& start, double limit_factor, Solve&& solve) {
    std::vector<int> cases;
    if (!problem_.load_cases.empty()) cases.push_back(critical_case(start));
    for (;;) {
      ProgramOutcome outcome = solve(cases);
      if (outcome.end == InteriorPointEnd::kCancelled) return outcome;
      // What the cases that took part are held to: with t, never less than the limit itself.
      const double factor = std::max(1.0, limit_factor * std::sqrt(std::max(outcome.elastic, 0.0)));
      const std::vector<CaseResponse> responses = solver_.solve(outcome.areas_mm2);
      const std::size_t before = cases.size();
      for (int k = 0; k < static_cast<int>(responses.size()); ++k)
        if (std::find(cases.begin(), cases.end(), k) == cases.end() &&
            demand_of(outcome.areas_mm2, responses, k) >
                factor * (1 + session_.options().feasibility_tolerance))
          cases.push_back(k);
      if (cases.size() == before) return outcome;
    }
  }

  // Minimises t in |d|^2 <= t epsilon^2 (and so for the strains) from the best uniform radius.
  SizedFrame least_utilisation(const std::vector<double>& start, double start_utilisation) {
    const double factor = std::isfinite(start_utilisation) ? start_utilisation : 1.0;
    const double enough = kElasticEnough / (factor * factor);
    const auto early = [&](const ProgramVector& point, const KktError& error) {
      return point.elastic <= enough && error.primal <= kElasticError;
    };
    const auto search = [&](const std::vector<double>& from, auto stop) {
      return over_cases(from, factor, [&](const std::vector<int>& cases) {
        ProgramRequest elastic = request(cases);
        elastic.limit_factor = factor;
        elastic.elastic = ElasticScope::kLimits;
        elastic.tolerance_factor = kElasticRoughly;
        elastic.initial_barrier = kElasticBarrier;
        return session_.solve(problem_, elastic, from, stop);
      });
    };
    ProgramOutcome outcome = search(start, early);
    // Its primal error may hide that the limits do not hold after all: then it stopped too early.
    if (outcome.end == InteriorPointEnd::kGoodEnough && !(utilisation(evaluated(outcome.areas_mm2)) <= 1))
      outcome = search(outcome.areas_mm2, nullptr);
    if (outcome.end == InteriorPointEnd::kCancelled) return cancelled();
    SizedFrame reached = at(Termination::kInfeasible, outcome.areas_mm2, "");
    const double best = utilisation(reached.evaluation);
    if (!(best <= start_utilisation))
      reached = at(Termination::kInfeasible, start, "");  // the search made it worse
    if (best <= 1 + session_.options().feasibility_tolerance) {
      reached.reason = Termination::kOptimal;
      return reached;
    }
    reached.kkt_error = outcome.kkt_error;
    reached.detail =
        outcome.converged() ? "a local optimum of the least violation" : "its search stopped early";
    return reached;
  }

  // The frame that leans least, when no areas within the bounds bring the centre of gravity over the base; a
  // linear program. No verdict where its search ended early; what it found is kept in balanced_mm2_.
  std::optional<SizedFrame> least_imbalance() {
    if (problem_.balance.empty()) return std::nullopt;
    const std::vector<double> middle = [&] {
      std::vector<double> areas = bounds_.lower_mm2;
      for (std::size_t j = 0; j < areas.size(); ++j) areas[j] = (areas[j] + bounds_.upper_mm2[j]) / 2;
      return areas;
    }();
    for (const auto& areas : {bounds_.lower_mm2, middle})
      if (evaluated(areas).balance_margin_mm >= 0) return std::nullopt;
    ProgramRequest elastic = request({});
    elastic.elastic = ElasticScope::kBalance;
    // The moments exceed t by the primal error at most: t < 0 alone does not mean that balance holds.
    const ProgramOutcome outcome =
        session_.solve(problem_, elastic, middle, [](const ProgramVector& point, const KktError& error) {
          return point.elastic < 0 && error.primal <= -point.elastic;
        });
    if (outcome.end == InteriorPointEnd::kCancelled) return cancelled();
    SizedFrame leaning = at(Termination::kInfeasible, outcome.areas_mm2, "");
    if (leaning.evaluation.balance_margin_mm >= -kBalanceToleranceMm || !outcome.converged()) {
      balanced_mm2_ = std::move(leaning.areas_mm2);
      return std::nullopt;
    }
    leaning.violated_constraint = "balance";
    leaning.detail = fmt::format("the centre of gravity comes within {:.4g} mm of the base",
                                 -leaning.evaluation.balance_margin_mm);
    auto proof = certify_unbalanced(problem_, certificate_request(leaning.areas_mm2));
    return judged(std::move(leaning), std::move(proof));
  }

  // What misses the limits by the program's tolerance only, thickened until it keeps them.
  std::optional<SizedFrame> repaired(const SizedFrame& sized) {
    SizedFrame trial = sized;
    for (int repair = 0; repair < kMostRepairs; ++repair) {
      const double used = utilisation(trial.evaluation);
      if (!(used > 1 && used < kRepairableUtilisation)) return std::nullopt;
      for (std::size_t j = 0; j < trial.areas_mm2.size(); ++j)
        trial.areas_mm2[j] = std::clamp(trial.areas_mm2[j] * used * (1 + kRepairRoom), bounds_.lower_mm2[j],
                                        bounds_.upper_mm2[j]);
      trial.evaluation = evaluated(trial.areas_mm2);
      if (!holds(trial.evaluation)) continue;
      if (trial.volume_mm3() > (1 + kOptimalRepair) * sized.volume_mm3())
        trial.reason = Termination::kIterationLimit;
      trial.detail += ", thickened until every limit holds";
      return trial;
    }
    return std::nullopt;
  }

  SizedFrame minimise_volume(const std::vector<double>& start, bool near) {
    const ProgramOutcome outcome = over_cases(start, 1.0, [&](const std::vector<int>& cases) {
      ProgramRequest least = request(cases);
      if (near) least.initial_barrier = kNearBarrier;
      return session_.solve(problem_, least, start);
    });
    if (outcome.end == InteriorPointEnd::kCancelled) return cancelled();
    const bool optimal = outcome.converged();
    SizedFrame sized = at(optimal ? Termination::kOptimal : Termination::kIterationLimit, outcome.areas_mm2,
                          optimal ? "a local optimum" : "the interior point stopped before its tolerance");
    sized.kkt_error = outcome.kkt_error;
    if (holds(sized.evaluation)) return sized;
    if (auto thickened = repaired(sized)) return *thickened;
    SizedFrame kept = at(Termination::kIterationLimit, start, "the interior point failed: its start is kept");
    kept.kkt_error = outcome.kkt_error;
    if (holds(kept.evaluation)) return kept;
    sized.reason = Termination::kInfeasible;
    sized.violated_constraint =
        violated_constraint(sized.evaluation, session_.options().feasibility_tolerance);
    auto proof = certify_infeasible(problem_, certificate_request(sized.areas_mm2));
    sized.detail = "where the search for the least volume ended";
    return judged(std::move(sized), std::move(proof));
  }

  const FrameProblem& problem_;
  Session& session_;
  const SizingEffort effort_;
  EquilibriumSolver solver_;
  ProgramRequest bounds_;
  std::vector<double> balanced_mm2_;  // where the search for balance ended; empty: it was not needed
};

}  // namespace

bool is_feasible(const Evaluation& evaluation, const OptimizeOptions& options) {
  return violated_constraint(evaluation, options.feasibility_tolerance).empty();
}

void take_sizing(Design& design, SizedFrame sized) {
  design.volume_mm3 = sized.volume_mm3();
  design.areas_mm2 = std::move(sized.areas_mm2);
  design.reason = sized.reason;
  design.detail = std::move(sized.detail);
  design.kkt_error = sized.kkt_error;
}

SizedFrame size_frame(const FrameProblem& problem, const std::vector<double>& hint_mm2, Session& session,
                      SizingEffort effort) {
  return Sizing(problem, session, effort).run(hint_mm2);
}

}  // namespace skinframe
