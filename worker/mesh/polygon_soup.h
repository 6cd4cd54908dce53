// SPDX-License-Identifier: GPL-3.0-or-later
// What the readers of indexed formats (OBJ, PLY, OFF) collect, and the one place where it is checked and
// becomes a MeshFile: indices in range, polygons cut into triangles, unused vertices dropped.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "worker/mesh/read_mesh.h"

namespace skinframe {

// The file's bytes with what every reader needs.
struct ReadRequest {
  std::string_view bytes;
  const ReadLimits& limits;
  RunContext& context;
};

struct PolygonSoup {
  struct Face {
    std::uint64_t first = 0;  // in corners
    std::uint64_t count = 0;
    std::uint64_t line = 0;  // of a text file; 0 in a binary one, where the face's number names it
  };
  std::vector<Eigen::Vector3d> vertices;             // finite
  std::vector<std::array<std::uint8_t, 3>> colours;  // one a vertex, or none at all
  std::vector<std::int64_t> corners;                 // from 0, not yet checked
  std::vector<Face> faces;
};

// "line 17" or, without a line, "face 41" (from 0).
std::string face_name(const PolygonSoup& soup, std::size_t face);

// Refuses the next element when there are `count` already.
Status check_count(std::uint64_t count, std::uint64_t limit, std::string_view what);

// index_base: what the format calls its first vertex (OBJ 1, others 0), for the messages.
Result<MeshFile> finish(PolygonSoup soup, std::string format, int index_base, const ReadRequest& request);

}  // namespace skinframe
