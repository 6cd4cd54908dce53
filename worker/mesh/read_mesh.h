// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a triangle mesh from a file: STL (binary, ASCII), OBJ, PLY (ASCII, both endians), OFF, 3MF.
//
// Guarantees:
//  1. The type is decided by the file's content, never by its name.
//  2. Every index of the mesh names a vertex, every coordinate is finite, there is at least one triangle.
//     Vertices that no triangle uses are dropped, so that the bounding box is that of the surface.
//  3. No memory is taken on the word of a header: a count is compared with the bytes that are there first.
//     What a 3MF package inflates to and how often its objects are placed is counted before memory is taken.
//  4. Nothing is written, and no file is opened but the one asked for.
//  5. Polygons are triangulated by ear clipping; nothing else is changed. STL corners that are equal to the
//     last bit share a vertex (STL knows no sharing); near misses are left to repair().
//
// Errors: kInvalidInput names the element ("line 17: ...", "triangle 41: index 9000 of 512 vertices");
// kUnsupported for a variant or a required 3MF extension that is not read; kIo when the file cannot be opened
// or read; kCancelled.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"
#include "worker/run/run_context.h"

namespace skinframe {

// Above these a file is refused before anything of its size is allocated.
struct ReadLimits {
  std::uint64_t max_file_bytes = std::uint64_t{1} << 30;
  std::uint64_t max_vertices = 20'000'000;   // at most 2^31 - 1: indices are int
  std::uint64_t max_triangles = 10'000'000;  // at most 2^31 - 1
  std::uint64_t max_polygon_corners = 4096;  // of one face; ear clipping is quadratic and worse
  // Of all polygons together, looking at one corner each: some seconds. A disc of 4096 corners takes 8
  // million, and outlines made for it a thousand times as many.
  std::uint64_t max_cutting_steps = 2'000'000'000;

  Status validate() const;
};

struct MeshFile {
  TriangleMesh mesh;  // in the file's own units; a 3MF file knows its unit and comes in mm
  // PLY with red, green, blue as uchar: one a vertex of `mesh`. Else empty.
  std::vector<std::array<std::uint8_t, 3>> vertex_colours;
  std::vector<std::string> comments;  // of a PLY header, the first few, as they are
  std::string format;                 // "STL (binary)", "STL (ASCII)", "OBJ", "PLY", "OFF", "3MF"
  std::vector<std::string> notes;     // what was done beside reading: "triangulated 12 polygons"
};

Result<MeshFile> read_mesh(const std::filesystem::path& path, const ReadLimits& limits, RunContext& context);

// The same for a file that is in memory already; messages begin without a name.
Result<MeshFile> read_mesh_bytes(std::string_view bytes, const ReadLimits& limits, RunContext& context);

}  // namespace skinframe
