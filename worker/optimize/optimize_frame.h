// SPDX-License-Identifier: GPL-3.0-or-later
// The least frame that keeps constraints (1)-(10): SizeOpt (15), then TopOpt (17-20) and GeoOpt (21) in turn
// until the volume falls by less than a percent. Algorithm 1 of Wang et al. 2013, from a given initial frame.
//
// Guarantees:
//  - Same problem and options, same result, bit for bit.
//  - The result is a value for every ending that is not cancellation or bad input: see Termination.
//  - Volumes of size, topology and geometry never rise from one to the next, beyond kVolumeTie.
//  - lower_bound_mm3 <= size volume, relaxed_lower_bound_mm3 <= topology volume.
//  - `evaluation` is computed afresh from radii and positions, not taken from the optimiser.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "worker/frame/half_space.h"
#include "worker/mechanics/evaluation.h"
#include "worker/mechanics/frame_problem.h"
#include "worker/optimize/infeasibility_certificate.h"
#include "worker/run/checkpoints.h"
#include "worker/run/result.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct OptimizeOptions {
  enum class Order {
    kPaper,  // SizeOpt, then TopOpt capped at SizeOpt's volume: the printed order
    kTight,  // relaxed minimum volume first, then TopOpt capped just above the volume reached: 30-65 % less
  };
  Order order = Order::kTight;

  // Which stages run. Sizing always runs; the others build upon it.
  bool relaxed = true;   // relaxed minimum volume, part of the topology stage; kTight only
  bool topology = true;  // reweighted removal of struts
  bool geometry = true;

  // The regions of the free nodes about the present frame, asked for before each geometry pass. Empty: a box
  // around each free node of half width region_share times the distance to its nearest neighbour, along
  // its struts. A box of that width bounds a pass in any case.
  std::function<NodeRegions(const Frame&, const std::vector<double>& radii_mm)> convex_regions;
  // Geometry's veto on a moved and re-sized frame. False: the pass's move is halved up to max_move_halvings
  // times, then the pass is dropped. Topology drops a removal that turns an accepted frame into one that is
  // not. Empty: every frame is accepted.
  std::function<bool(const Frame&, const std::vector<double>& radii_mm)> accepts;

  // Whether lower bounds on the volume are computed, after sizing and after the first topology stage. They
  // change nothing else.
  bool bounds = true;

  // Radii near the optimum, one a strut of the problem, where the first sizing starts; empty: none are known.
  // They change the way and not the optimum, within the tolerances below; poor ones are not used.
  std::vector<double> hint_radii_mm;

  // Where the stages are kept and an earlier attempt is gone on from; it changes nothing in the result. Null:
  // nowhere.
  Checkpoints* checkpoints = nullptr;

  // Interior point: scaled Karush-Kuhn-Tucker error <= kkt_tolerance (nondimensional problem), range (0,
  // 1e-3].
  double kkt_tolerance = 1e-7;
  int max_interior_point_iterations = 300;  // of one program, > 0
  // Gets a line for each iteration of each program, and a heading before. Empty: no log.
  std::function<void(const std::string&)> log;

  // A frame is feasible when every ratio <= 1 + feasibility_tolerance, range (0, 1e-2].
  double feasibility_tolerance = 1e-6;

  // Algorithm 1 stops when volume > (1 - outer_decrease) * volume before, range [0, 1).
  double outer_decrease = 0.01;
  int max_outer_iterations = 10;  // > 0

  // TopOpt: cap = (1 + topology_cap_room) * volume (20), range (0, 1).
  double topology_cap_room = 0.005;
  int topology_reweightings = 2;  // > 0
  // Weights proportional to 1 / (topology_xi * mean area + A), range (0, 1]: xi of (18), linear in A and not
  // in r, since a xi of 1e-7 in r fails in every solver tried.
  double topology_xi = 0.05;
  // A strut goes when A <= removal_share * lower bound, after the relaxed and after the reweighted program;
  // (0, 1).
  double relaxed_removal_share = 0.25;
  double topology_removal_share = 0.05;

  // GeoOpt: passes a round; a pass counts when volume <= (1 - geometry_decrease) * volume before.
  int max_geometry_passes = 4;       // > 0
  double geometry_decrease = 0.002;  // [0, 1)
  double region_share = 3;           // of the distance to the nearest neighbour, (0, 100]
  // A strut of a free node shorter than this share of the mean of such struts is contracted where the sized
  // result is no larger, [0, 1); 0: none is.
  double merge_share = 0.35;
  double min_length_mm = 0;   // struts of free nodes stay at least this long; 0: half of their present length
  int max_move_halvings = 3;  // >= 0

  Status validate() const;
};

// Two volumes closer than this, relative, count as equal: then the frame with fewer struts is taken.
inline constexpr double kVolumeTie = 1e-7;

enum class Termination {
  kOptimal,         // every stage ended at its optimum (a local one for topology and geometry)
  kInfeasible,      // no frame keeps the constraints: violated_constraint says which, detail whether that is
                    // proven or the best reachable is merely a local optimum; radii are at the best reachable
  kIterationLimit,  // feasible, but the last sizing stopped before its tolerance
};

const char* to_string(Termination termination);

struct StageRecord {
  int nodes = 0;
  int struts = 0;
  double volume_mm3 = 0;
  std::vector<double> radii_mm, lengths_mm;  // one a strut, in the order of the stage's frame
};

// Of a frame with these radii. lengths_mm and the counts are the frame's.
StageRecord record_of(const Frame& frame, std::vector<double> radii_mm, double volume_mm3);

struct OptimizeResult {
  Termination reason = Termination::kOptimal;
  std::string detail;                                          // one sentence for people
  FrameProblem problem;                                        // the reduced frame at its final positions
  std::vector<double> radii_mm;                                // one a strut of problem.frame
  std::vector<std::vector<Eigen::Vector3d>> displacements_mm;  // one list a load case
  Evaluation evaluation;                                       // of radii_mm in problem
  // initial: the frame as given, at its lower bounds. size, topology, geometry: sized frames; a stage that
  // did not run repeats the one before.
  StageRecord initial, size, topology, geometry;
  int outer_iterations = 0;           // of Algorithm 1
  int interior_point_iterations = 0;  // over all programs, as are the next two
  int factorisations = 0;             // of the interior point's system
  double interior_point_seconds = 0;  // contained in `seconds`
  double kkt_residual = 0;            // of the last sizing: scaled, nondimensional
  // No frame of the input's nodes and struts, each radius within its bounds and slenderness, keeps the limits
  // with less volume (volume_lower_bound.h); gap = size volume / bound - 1. Absent: infeasible or not asked
  // for.
  std::optional<double> lower_bound_mm3, gap;
  // The same where removable struts may also be absent (design.h): of every frame that removing struts can
  // make, nodes where they are in the input; gap = topology volume / bound - 1. Absent: nothing was removed.
  std::optional<double> relaxed_lower_bound_mm3, relaxed_gap;
  std::optional<DualProof> lower_bound_proof, relaxed_lower_bound_proof;  // of the input's nodes and struts
  // Infeasible and proven: no radii within their bounds keep the limits. The problem is then `problem`, which
  // has the input's nodes and struts.
  std::optional<InfeasibilityCertificate> certificate;
  std::optional<double> best_reachable_displacement_mm;  // when that is violated_constraint
  std::string
      violated_constraint;  // when infeasible: displacement, axial stress, shear stress, balance, equilibrium
  std::map<std::string, double> seconds;  // "size", "topology", "geometry", "bound"
  // Index in the input frame, one a node of problem.frame; a node that took others in keeps its own.
  std::vector<int> node_origin;
  std::vector<int> strut_origin;  // the same for struts; of struts that became one, of the one that stayed
};

// Errors: invalid input (problem or options), cancelled, internal (a library gave up). std::bad_alloc passes
// through.
Result<OptimizeResult> optimize_frame(const FrameProblem& problem, const OptimizeOptions& options,
                                      RunContext& context);

}  // namespace skinframe
