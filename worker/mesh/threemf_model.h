// SPDX-License-Identifier: GPL-3.0-or-later
// One model part of a 3MF package (3MF Core Specification 1.3, chapters 3 and 4), as its XML says it: objects
// that are meshes or are put together from others, and the build. Internal to the room.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "worker/mesh/polygon_soup.h"

namespace skinframe {

using Placing = Eigen::Transform<double, 3, Eigen::AffineCompact>;

// Another object, put in its place: a component of an object or an item of the build.
struct ThreeMfReference {
  std::uint32_t object = 0;
  std::string part;  // where that object is (Production Extension 1.1); empty: in this part
  Placing placing = Placing::Identity();
  bool printable = true;  // slicers mark an item so that stays in the file but is not printed
};

struct ThreeMfObject {
  std::uint32_t id = 0;
  std::string type = "model";
  std::vector<Eigen::Vector3d> vertices;      // finite, in the part's unit
  std::vector<std::array<int, 3>> triangles;  // each index names a vertex of this object
  std::vector<ThreeMfReference> components;
  bool has_beams = false;  // a beam lattice, which is passed over
};

struct ThreeMfModel {
  std::string unit = "millimeter";
  double mm_per_unit = 1;
  std::vector<ThreeMfObject> objects;  // in the file's order, ids distinct
  std::vector<ThreeMfReference> build;
};

// What all parts of a package may hold together.
struct ThreeMfCounts {
  std::uint64_t vertices = 0, triangles = 0, objects = 0, references = 0;
};

// Reads the part as it is fed in chunks.
class ThreeMfReader {
 public:
  // `counts` goes on from part to part. Name, limits and counts must outlive the reader.
  ThreeMfReader(const std::string& part_name, const ReadLimits& limits, ThreeMfCounts& counts);
  ~ThreeMfReader();
  ThreeMfReader(const ThreeMfReader&) = delete;
  ThreeMfReader& operator=(const ThreeMfReader&) = delete;

  Status feed(std::string_view chunk);
  // kInvalidInput names line or element; kUnsupported an extension that the part requires.
  Result<ThreeMfModel> finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skinframe
