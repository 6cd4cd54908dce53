// SPDX-License-Identifier: GPL-3.0-or-later
// Writes 3MF packages (3MF Core Specification 1.2): unit millimetre, named objects, metadata; the struts of a
// frame as beams (Beam Lattice Extension 1.1) in a package of their own. Slicers that do not know the
// extension must refuse a package that requires it, and PrusaSlicer drops beams without a word; so the mesh
// to print stands apart and requires nothing.
//
// Guarantees: coordinates are the shortest decimals that read back as the same floats; same input, same
// bytes; under `path` there is either the whole new file or whatever was there before. Text is cleaned for
// XML. The package is streamed: no copy of the mesh as text is held.
//
// lib3mf 1.8 was weighed and not taken: it holds mesh, XML and package in memory at once, and stamps the time
// into every package.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "worker/frame/frame.h"
#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"

namespace skinframe {

struct ThreemfText {
  std::string object;  // name of the object, for the slicer's list
  std::string title, description;
};

// Errors: kIo names the path; kInvalidInput when a coordinate is no finite float.
Status write_3mf(const TriangleMesh& mesh, const ThreemfText& text, const std::filesystem::path& path);

// One beam a strut, round, with spherical caps; radii_mm: one a strut.
Status write_beams_3mf(const Frame& frame, const std::vector<double>& radii_mm, const ThreemfText& text,
                       const std::filesystem::path& path);

}  // namespace skinframe
