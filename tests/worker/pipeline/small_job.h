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

// Leans 45 degrees and bridges 8 mm.
inline PrinterRequest makerbot_pla() {
  PrinterRequest request;
  request.printer = {"makerbot-replicator-2", PrintProcess::kExtrusion, 0.4, {225, 145, 150}, 5};
  auto curve = PrintableLength::make({{45, std::nullopt}, {60, 16.0}, {90, 8.0}}, false, "made up");
  SKINFRAME_CHECK(curve.ok());
  request.printer.printable_length = std::move(curve).value();
  request.material = {"pla", 2673, 1533, 92, 52, 60, 1.24};
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
  request.options.verify = false;  // tests of the verification ask for it
  return request;
}

}  // namespace skinframe::test
