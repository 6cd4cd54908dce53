// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sample/make_sample.h"

#include <fmt/format.h>

#include <exception>

#include "worker/sample/bodies.h"
#include "worker/sample/mesh_body.h"
#include "worker/solid/place.h"
#include "worker/solid/solid.h"

namespace skinframe {
namespace {

constexpr double kLargestEdgeMm = 200;

}  // namespace

std::vector<SampleInfo> samples() {
  std::vector<SampleInfo> infos;
  for (Body& body : sample_bodies()) infos.push_back(std::move(body.info));
  return infos;
}

Result<TriangleMesh> make_sample(const std::string& name, RunContext& context) {
  std::string known;
  for (const Body& body : sample_bodies()) {
    known += (known.empty() ? "" : ", ") + body.info.name;
    if (body.info.name != name) continue;
    if (context.cancelled()) return cancelled_error();
    try {
      // Through Solid: what is given out is closed by its type, and stays so as a binary STL.
      Result<Solid> solid = Solid::make(put_on_plate(scale_to_largest_edge(mesh_body(body), kLargestEdgeMm)));
      if (!solid.ok()) return internal_error(fmt::format("sample {}: {}", name, solid.error().message));
      return solid->mesh();
    } catch (const std::exception& e) {
      return internal_error(fmt::format("sample {}: {}", name, e.what()));
    }
  }
  return invalid_input(
      fmt::format("there is no sample \"{}\"; the samples are {}", name.substr(0, 40), known));
}

}  // namespace skinframe
