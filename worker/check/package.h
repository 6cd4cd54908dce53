// SPDX-License-Identifier: GPL-3.0-or-later
// A 3MF package read back by the check's own few lines: enough for what this project writes, nothing more.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"

namespace skinframe::check {

struct Beam {
  int a = 0, b = 0;
  double radius_a_mm = 0, radius_b_mm = 0;
};

struct Package {
  std::string unit, object_name, required_extensions;
  TriangleMesh mesh;
  std::vector<Beam> beams;
};

// Errors: kIo and kInvalidInput, naming the file and what is wrong with it.
Result<Package> read_package(const std::filesystem::path& path);

}  // namespace skinframe::check
