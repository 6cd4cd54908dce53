// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies that ship with the program: what the demo and the tests print. Each is the zero set of an
// implicit function of our own, meshed by OpenVDB; nothing is read from disk.
//
// Guarantees: closed, edge-manifold, outward; 10k to 60k triangles; the largest edge of the box is 200 mm; it
// stands on a flat base at z = 0, centred in x and y; the same bytes on every run.
#pragma once

#include <string>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct SampleInfo {
  std::string name;
  std::string description;  // one line
};

std::vector<SampleInfo> samples();

// Error: kInvalidInput for an unknown name, listing the known ones.
Result<TriangleMesh> make_sample(const std::string& name, RunContext& context);

}  // namespace skinframe
