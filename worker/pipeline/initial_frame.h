// SPDX-License-Identifier: GPL-3.0-or-later
// PRINTER/initial-frame.json: what a later job of the same mesh starts from. It is the problem that the
// optimiser was given, as a problem file (worker/problem/problem_file.h: `solve-frame` takes it), and beside
// it
//
//   "sampling": {"key": of sampling_key(), "finger_edge_mm", "contact_nodes": [..], "skin_nodes_requested",
//                "skin_nodes_sampled", "density", "mean_skin_edge_mm", "worst_outward_chord_mm",
//                "worst_inward_chord_mm", "skin_struts_outside", "struts_left_out_crossing", "pieces",
//                "openings": [{"centre_mm", "axis", "radius_mm", "rise_mm", "clear_mm"}..], "warnings": [..]}
//   "reduced":  null, or what the optimiser left of it: {"nodes": [[x,y,z]..], "struts": [[a,b,skin]..],
//                "radii_mm": [..], "volume_mm3"}
//
// It comes back through a server, so that it is read as a stranger's file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "worker/frame/sample_frame.h"
#include "worker/mechanics/frame_problem.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

struct ReducedFrame {
  Frame frame;  // its skin nodes and skin triangles are those of the sampled frame
  std::vector<double> radii_mm;
  double volume_mm3 = 0;
};

struct InitialFrame {
  FrameProblem problem;  // of the earlier job, on the sampled frame
  SampledFrame sampled;
  std::string density;  // that its nodes follow
  std::string key;
  std::optional<ReducedFrame> reduced;
};

// Tells what a sampled frame has to fit: M1, the counts asked for, the strut radius, the seed and the
// program's version. Not the loads, nor the finger rule's edge: see still_fine_enough in earlier_frame.h.
std::string sampling_key(const Skin& skin, const FrameOptions& options, const RunContext& context);

// result: none when nothing was optimised or nothing feasible found. Its lower bounds are of `posed`, and so
// are their proofs (proof_json.h), which stand beside it.
nlohmann::json initial_frame_json(const FrameProblem& posed, const SampledFrame& sampled,
                                  const std::string& density, const std::string& key,
                                  const OptimizeResult* result);

// Errors name the field.
Result<InitialFrame> read_initial_frame(const std::filesystem::path& path);

}  // namespace skinframe
