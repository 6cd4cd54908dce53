// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/optimize_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>

#include "worker/optimize/algorithm_state.h"
#include "worker/optimize/block_ldlt.h"
#include "worker/optimize/design.h"
#include "worker/optimize/geometry_stage.h"
#include "worker/optimize/session.h"
#include "worker/optimize/size_frame.h"
#include "worker/optimize/topology_stage.h"
#include "worker/optimize/volume_lower_bound.h"
#include "worker/run/one_blas_thread.h"

namespace skinframe {
StageRecord record_of(const Frame& frame, std::vector<double> radii_mm, double volume_mm3) {
  StageRecord record{static_cast<int>(frame.nodes_mm.size()),
                     static_cast<int>(frame.struts.size()),
                     volume_mm3,
                     std::move(radii_mm),
                     {}};
  record.lengths_mm.reserve(frame.struts.size());
  for (const Strut& strut : frame.struts) record.lengths_mm.push_back(frame.length_mm(strut));
  return record;
}

const char* to_string(Termination termination) {
  switch (termination) {
    case Termination::kOptimal:
      return "optimal";
    case Termination::kInfeasible:
      return "infeasible";
    case Termination::kIterationLimit:
      return "iteration_limit";
  }
  return "unknown";
}

Status OptimizeOptions::validate() const {
  const auto require = [](bool holds, const char* what) -> Status {
    return holds ? ok_status() : Status(invalid_input(fmt::format("optimize options: {}", what)));
  };
  for (const Status& status :
       {require(kkt_tolerance > 0 && kkt_tolerance <= 1e-3, "kkt_tolerance must lie in (0, 1e-3]"),
        require(max_interior_point_iterations > 0, "max_interior_point_iterations must be positive"),
        require(feasibility_tolerance > 0 && feasibility_tolerance <= 1e-2,
                "feasibility_tolerance must lie in (0, 1e-2]"),
        require(outer_decrease >= 0 && outer_decrease < 1, "outer_decrease must lie in [0, 1)"),
        require(max_outer_iterations > 0, "max_outer_iterations must be positive"),
        require(topology_cap_room > 0 && topology_cap_room < 1, "topology_cap_room must lie in (0, 1)"),
        require(topology_reweightings > 0, "topology_reweightings must be positive"),
        require(topology_xi > 0 && topology_xi <= 1, "topology_xi must lie in (0, 1]"),
        require(relaxed_removal_share > 0 && relaxed_removal_share < 1,
                "relaxed_removal_share must lie in (0, 1)"),
        require(topology_removal_share > 0 && topology_removal_share < 1,
                "topology_removal_share must lie in (0, 1)"),
        require(max_geometry_passes > 0, "max_geometry_passes must be positive"),
        require(geometry_decrease >= 0 && geometry_decrease < 1, "geometry_decrease must lie in [0, 1)"),
        require(region_share > 0 && region_share <= 100, "region_share must lie in (0, 100]"),
        require(merge_share >= 0 && merge_share < 1, "merge_share must lie in [0, 1)"),
        require(min_length_mm >= 0, "min_length_mm must not be negative"),
        require(max_move_halvings >= 0, "max_move_halvings must not be negative")})
    if (!status.ok()) return status;
  return ok_status();
}

namespace {

// Algorithm 1 from a sized frame on, and what is said about it.
class Algorithm {
 public:
  Algorithm(const FrameProblem& problem, const OptimizeOptions& options, RunContext& context)
      : options_(options),
        given_(problem),
        checkpoints_(options.checkpoints),
        key_(checkpoints_ != nullptr ? algorithm_key(problem, options) : ""),
        session_(options, context),
        design_(initial_design(problem)) {
    ProgramRequest bounds;
    set_size_bounds(problem, bounds);
    std::vector<double> radii_mm = radii_of(bounds.lower_mm2);
    const double volume_mm3 = frame_volume_mm3(problem.frame, radii_mm);
    result_.initial = record_of(problem.frame, std::move(radii_mm), volume_mm3);
  }

  Result<OptimizeResult> run() {
    if (!go_on()) {
      size();
      if (session_.cancelled()) return cancelled_error();
      if (design_.reason != Termination::kInfeasible) keep(Stage::kSize);
    }
    if (design_.reason != Termination::kInfeasible) reduce();
    if (session_.cancelled()) return cancelled_error();
    return finish();
  }

 private:
  template <class Act>
  void timed(const char* stage, Stage progress_stage, Act&& act) {
    const auto start = std::chrono::steady_clock::now();
    session_.enter(progress_stage);
    act();
    result_.seconds[stage] += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void size() {
    timed("size", Stage::kSize, [&] {
      SizedFrame sized = size_frame(design_.problem, areas_of(options_.hint_radii_mm), session_,
                                    SizingEffort::kBestReachable);
      if (sized.cancelled) return;
      result_.violated_constraint = sized.violated_constraint;
      result_.certificate = std::move(sized.certificate);
      if (sized.violated_constraint == "displacement")
        result_.best_reachable_displacement_mm = sized.evaluation.max_displacement_mm;
      if (sized.lower_bound_mm3) sized.detail += ": the global optimum for the nodes and struts given";
      take_sizing(design_, std::move(sized));
      design_.warm = session_.latest();
    });
    result_.size = result_.topology = result_.geometry = present();
    if (session_.cancelled() || !options_.bounds || design_.reason == Termination::kInfeasible) return;
    timed("bound", Stage::kSize, [&] {
      VolumeBound bound = bound_below(design_.problem, design_.areas_mm2, {}, result_.size.volume_mm3);
      result_.gap = gap_above(bound.value_mm3, result_.size.volume_mm3);
      result_.lower_bound_mm3 = bound.value_mm3;
      result_.lower_bound_proof = std::move(bound.proof);
    });
  }

  VolumeBound bound_below(const FrameProblem& problem, const std::vector<double>& areas_mm2,
                          const std::vector<bool>& may_vanish, double volume_mm3) const {
    BoundRequest request;
    request.box = area_box(problem, may_vanish);
    request.start_mm2 = areas_mm2;
    request.volume_mm3 = volume_mm3;
    request.feasibility_tolerance = options_.feasibility_tolerance;
    request.cancelled = [this] { return session_.cancelled(); };
    return volume_lower_bound(problem, request);
  }

  static std::optional<double> gap_above(double bound_mm3, double volume_mm3) {
    return bound_mm3 > 0 ? std::optional(volume_mm3 / bound_mm3 - 1) : std::nullopt;
  }

  // Of what topology optimisation has made of the frame that was sized.
  void bound_removal(const Design& sized) {
    const std::vector<bool> removable = removable_struts(sized.problem);
    if (!options_.bounds || std::find(removable.begin(), removable.end(), true) == removable.end()) return;
    timed("bound", Stage::kTopology, [&] {
      VolumeBound bound = bound_below(sized.problem, sized.areas_mm2, removable, result_.topology.volume_mm3);
      result_.relaxed_gap = gap_above(bound.value_mm3, result_.topology.volume_mm3);
      result_.relaxed_lower_bound_mm3 = bound.value_mm3;
      result_.relaxed_lower_bound_proof = std::move(bound.proof);
    });
  }

  // TopOpt and GeoOpt in turn until the volume falls by less than outer_decrease.
  void reduce() {
    const bool topology =
        options_.topology || (options_.relaxed && options_.order == OptimizeOptions::Order::kTight);
    if (!topology && !options_.geometry) return;
    while (!loop_.ended && loop_.round < options_.max_outer_iterations) {
      if (!loop_.after_topology) topology_half(topology);
      if (session_.cancelled()) return;
      if (loop_.round > 0 && loop_.settled &&
          static_cast<int>(design_.problem.frame.struts.size()) == loop_.struts_before)
        return;  // geometry has already had this frame
      geometry_half();
      if (session_.cancelled()) return;
      loop_.after_topology = false;
      loop_.ended = design_.volume_mm3 > (1 - options_.outer_decrease) * loop_.volume_before_mm3;
      ++loop_.round;
      keep(Stage::kGeometry);
    }
  }

  void topology_half(bool wanted) {
    loop_.volume_before_mm3 = design_.volume_mm3;
    loop_.struts_before = static_cast<int>(design_.problem.frame.struts.size());
    const bool first = loop_.round == 0;
    const Design before = first ? design_ : Design();
    if (wanted)
      timed("topology", Stage::kTopology,
            [&] { design_ = optimise_topology(std::move(design_), !first || !options_.geometry, session_); });
    if (session_.cancelled()) return;
    if (first) {
      result_.topology = present();
      if (wanted) bound_removal(before);
      if (session_.cancelled()) return;
    }
    loop_.after_topology = true;
    if (wanted) keep(Stage::kTopology);
  }

  void geometry_half() {
    // Once geometry has settled, what topology changed has to be worth another pass.
    const bool changed = design_.volume_mm3 <= (1 - options_.geometry_decrease) * loop_.volume_before_mm3;
    if (options_.geometry && (loop_.round == 0 || changed || !loop_.settled))
      timed("geometry", Stage::kGeometry, [&] {
        GeometryOutcome outcome = optimise_geometry(std::move(design_), session_);
        design_ = std::move(outcome.design);
        loop_.settled = outcome.settled;
      });
    if (session_.cancelled()) return;
    result_.geometry = present();
    result_.outer_iterations = loop_.round + 1;
  }

  StageRecord present() const {
    return record_of(design_.problem.frame, radii_of(design_.areas_mm2), design_.volume_mm3);
  }

  void keep(Stage finished) {
    if (checkpoints_ == nullptr || session_.cancelled()) return;
    AlgorithmState state{loop_, design_, session_.state(), result_};
    checkpoints_->keep(key_, to_string(finished), to_bytes(state));
  }

  // From where an earlier attempt was broken off. False: from the beginning.
  bool go_on() {
    const auto bytes = checkpoints_ != nullptr ? checkpoints_->find(key_) : std::nullopt;
    if (!bytes) return false;
    auto state = algorithm_state(*bytes, given_);
    if (!state) {
      checkpoints_->refused("the optimiser's state is damaged");
      return false;
    }
    loop_ = state->loop;
    design_ = std::move(state->design);
    session_.state() = std::move(state->session);
    result_ = std::move(state->so_far);
    const bool sized_only = loop_.round == 0 && !loop_.after_topology;
    checkpoints_->used(to_string(sized_only             ? Stage::kSize
                                 : loop_.after_topology ? Stage::kTopology
                                                        : Stage::kGeometry));
    return true;
  }

  OptimizeResult finish() {
    result_.radii_mm = radii_of(design_.areas_mm2);
    const std::vector<CaseResponse> responses = solve_equilibrium(design_.problem, design_.areas_mm2);
    result_.evaluation = evaluate(design_.problem, result_.radii_mm, responses);
    for (const CaseResponse& response : responses)
      result_.displacements_mm.push_back(response.displacements_mm);
    conclude();
    result_.interior_point_iterations = session_.effort().iterations;
    result_.factorisations = session_.effort().factorisations;
    result_.interior_point_seconds = session_.effort().seconds;
    result_.node_origin = std::move(design_.node_origin);
    result_.strut_origin = std::move(design_.strut_origin);
    result_.problem = std::move(design_.problem);
    return std::move(result_);
  }

  // What is said is about the frame that is handed over: its own sizing, and its evaluation from scratch.
  void conclude() {
    result_.reason = design_.reason;
    result_.detail = design_.detail;
    result_.kkt_residual = design_.kkt_error;
    if (result_.reason == Termination::kInfeasible || is_feasible(result_.evaluation, options_)) return;
    result_.reason = Termination::kInfeasible;
    result_.violated_constraint = violated_constraint(result_.evaluation, options_.feasibility_tolerance);
    result_.detail = fmt::format("{} is not kept by the frame reached", result_.violated_constraint);
  }

  const OptimizeOptions& options_;
  const FrameProblem& given_;
  Checkpoints* const checkpoints_;
  const std::string key_;
  Session session_;
  Design design_;
  OuterLoop loop_;
  OptimizeResult result_;
};

}  // namespace

Result<OptimizeResult> optimize_frame(const FrameProblem& problem, const OptimizeOptions& options,
                                      RunContext& context) {
  if (Status s = validate(problem); !s.ok()) return s.error();
  if (Status s = options.validate(); !s.ok()) return s.error();
  if (!options.hint_radii_mm.empty() && options.hint_radii_mm.size() != problem.frame.struts.size())
    return invalid_input(fmt::format("optimize options: {} hint_radii_mm for {} struts",
                                     options.hint_radii_mm.size(), problem.frame.struts.size()));
  if (context.cancelled()) return cancelled_error();
  use_one_blas_thread();
  try {
    return Algorithm(problem, options, context).run();
  } catch (const std::bad_alloc&) {  // no fault of the optimiser: whoever owns the process decides
    throw;
  } catch (const std::exception& e) {  // what Eigen or the caller's functions throw
    return internal_error(fmt::format("the optimiser gave up: {}", e.what()));
  }
}

}  // namespace skinframe
