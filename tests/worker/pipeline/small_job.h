// SPDX-License-Identifier: GPL-3.0-or-later
// A whole job on a sample body, small enough for a test: few nodes, a coarse body, one printer of the paper.
#pragma once

#include <filesystem>
#include <string>

#include "tests/fixture/temporary_folder.h"
#include "worker/mesh/write_stl.h"
#include "worker/pipeline/pipeline.h"
#include "worker/sample/make_sample.h"

namespace skinframe::test {

inline PrinterRequest sinterstation_pa() {
  PrinterRequest request;
  request.printer = {"sinterstation-hiq", PrintProcess::kPowder, 0.5, {457, 380, 330}, 5};
  request.material = {"pa", 1586, 1387, 43, 48, 60, 1.15};
  return request;
}

inline JobRequest sample_job(const std::string& sample, double size_mm, int skin_nodes,
                             const std::filesystem::path& folder) {
  RunContext context;
  auto mesh = make_sample(sample, context);
  SKINFRAME_CHECK(mesh.ok());
  JobRequest request;
  request.job_id = "test";
  request.mesh_name = sample + ".stl";
  request.mesh_path = folder / request.mesh_name;
  SKINFRAME_CHECK(write_stl(*mesh, request.mesh_path).ok());
  request.printers = {sinterstation_pa()};
  request.options.size_mm = size_mm;
  if (skin_nodes > 0) request.options.skin_nodes = skin_nodes;
  return request;
}

}  // namespace skinframe::test
