// SPDX-License-Identifier: GPL-3.0-or-later
// The header of a PLY file (Turk 1994): which elements follow, of which properties, in which encoding.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "worker/run/result.h"

namespace skinframe {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

std::size_t size_of(PlyType type);
bool is_integer(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;   // of the value, or of a list's items
  std::optional<PlyType> count_type;  // set for a list; an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  std::optional<std::size_t> find(std::string_view property) const;
  std::uint64_t least_record_bytes(PlyFormat format) const;  // with every list empty
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  // the first few, their beginnings
  std::size_t body_offset = 0;
  std::uint64_t line_count = 0;
};

inline constexpr std::size_t kMostPlyComments = 32, kMostPlyCommentBytes = 200;

// Guarantee: no element announces more records than the bytes behind the header can hold.
Result<PlyHeader> read_ply_header(std::string_view bytes);

}  // namespace skinframe
