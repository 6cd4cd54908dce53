// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a mesh file: there is an error with a sentence or a mesh that keeps what read_mesh.h promises.
// The limits are small, so that the fuzzer spends its time in the readers and not in large files.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "worker/mesh/read_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace skinframe;
  ReadLimits limits;
  limits.max_file_bytes = 1 << 20;
  limits.max_vertices = limits.max_triangles = 100'000;
  limits.max_polygon_corners = 256;
  RunContext context;
  const auto file = read_mesh_bytes({reinterpret_cast<const char*>(data), size}, limits, context);
  if (!file.ok()) {
    SKINFRAME_CHECK(!file.error().message.empty());
    return 0;
  }
  SKINFRAME_CHECK(!file->mesh.triangles.empty());
  SKINFRAME_CHECK(file->mesh.triangles.size() <= limits.max_triangles);
  SKINFRAME_CHECK(file->mesh.vertices.size() <= limits.max_vertices);
  for (const auto& v : file->mesh.vertices) {
    for (const double x : v) SKINFRAME_CHECK(std::isfinite(x));
  }
  for (const auto& t : file->mesh.triangles) {
    for (const int v : t) SKINFRAME_CHECK(v >= 0 && static_cast<std::size_t>(v) < file->mesh.vertices.size());
  }
  return 0;
}
