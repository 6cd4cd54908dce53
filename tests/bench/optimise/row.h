// SPDX-License-Identifier: GPL-3.0-or-later
// One row of the table: a method on a frame under a load. What is not known stays empty.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace skinframe::bench {

// Nodes, struts and volume after a stage.
struct StageSize {
  int nodes = 0, struts = 0;
  double volume_mm3 = 0;
};

struct Row {
  std::string frame, load, method;
  int nodes = 0, struts = 0;  // of the problem
  double force_n = 0;
  std::string status;             // how it ended; "optimal", "feasible", ... or what went wrong
  std::optional<double> seconds;  // wall clock of the whole method: its start, and what it proves, included
  std::optional<double> cpu_seconds;    // the same of all threads
  std::optional<double> solve_seconds;  // of it, wall clock within the interior point: Ipopt's, or ours
  std::optional<int> iterations;        // of the interior point; of MMA's model; solves of the uniform search
  std::optional<int> factorisations;
  std::optional<double> volume_mm3;       // of the frame handed over
  std::optional<double> lower_bound_mm3;  // of SizeOpt
  std::optional<double> relaxed_gap;      // of the topology volume over the bound of the relaxed problem
  std::optional<double> size_volume_mm3;  // of SizeOpt on the way
  std::optional<int> struts_left;
  std::optional<double> worst_ratio;  // demand over limit, evaluated from scratch; at most 1 when it holds
  std::optional<double> kkt_error;    // of the last sizing; each solver's own scaling
  std::optional<double> peak_mb;      // resident memory of the method's process, problem file included
  std::vector<StageSize> stages;      // of the whole loop: initial, size, topology, geometry

  std::optional<double> gap() const;  // of SizeOpt: volume / lower bound - 1
};

nlohmann::json to_json(const Row& row);
Row row_from_json(const nlohmann::json& json);

}  // namespace skinframe::bench
