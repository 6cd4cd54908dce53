// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a mesh as binary STL (80 byte header, little endian floats).
//
// Guarantee: under `path` there is either the whole new file or whatever was there before; the bytes go to
// a temporary name beside it, are flushed, then renamed. Errors: kIo names the path and the system's reason;
// kInvalidInput when a coordinate is not representable as a finite float or an index names no vertex.
#pragma once

#include <filesystem>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"

namespace skinframe {

Status write_stl(const TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace skinframe
