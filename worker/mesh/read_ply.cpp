// SPDX-License-Identifier: GPL-3.0-or-later
// PLY, ASCII and binary of both endians. Elements other than "vertex" and "face" and properties other than
// x, y, z, the index list, and red, green, blue where all three are uchar, are read over.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "worker/mesh/mesh_formats.h"
#include "worker/mesh/ply_header.h"
#include "worker/mesh/text_scanner.h"

namespace skinframe {
namespace {

// The values behind the header, one after the other, whatever the encoding. Every integer type of PLY is
// exact in a double.
class PlyValues {
 public:
  PlyValues(std::string_view body, PlyFormat format, std::uint64_t header_lines)
      : body_(body), lines_(body), format_(format), header_lines_(header_lines) {}

  // Empty when the file ends or, in text, the word is no number. May be NaN in a binary file.
  std::optional<double> next(PlyType type) {
    return format_ == PlyFormat::kAscii ? next_word() : next_binary(type);
  }
  // Reads over `count` values; false when the file ends before.
  bool skip(PlyType type, std::uint64_t count) {
    if (format_ == PlyFormat::kAscii) {
      for (; count > 0; --count) {
        if (word().empty()) return false;
      }
      return true;
    }
    if (count > (body_.size() - position_) / size_of(type)) return false;
    position_ += count * size_of(type);
    return true;
  }
  // Text only; 0 in a binary file.
  std::uint64_t line() const {
    return format_ == PlyFormat::kAscii ? header_lines_ + lines_.line_number() : 0;
  }

 private:
  std::string_view word() {
    std::string_view found = take_word(rest_);
    while (found.empty()) {
      const auto line = lines_.next();
      if (!line) return {};
      rest_ = *line;
      found = take_word(rest_);
    }
    return found;
  }
  std::optional<double> next_word() { return parse_finite(word()); }

  std::optional<double> next_binary(PlyType type) {
    const std::size_t size = size_of(type);
    if (body_.size() - position_ < size) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = format_ == PlyFormat::kLittleEndian ? size - 1 - i : i;
      bits = bits << 8 | static_cast<unsigned char>(body_[position_ + place]);
    }
    position_ += size;
    switch (type) {
      case PlyType::kInt8:
        return static_cast<std::int8_t>(bits);
      case PlyType::kUint8:
        return static_cast<std::uint8_t>(bits);
      case PlyType::kInt16:
        return static_cast<std::int16_t>(bits);
      case PlyType::kUint16:
        return static_cast<std::uint16_t>(bits);
      case PlyType::kInt32:
        return static_cast<std::int32_t>(bits);
      case PlyType::kUint32:
        return static_cast<std::uint32_t>(bits);
      case PlyType::kFloat32:
        return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      case PlyType::kFloat64:
        return std::bit_cast<double>(bits);
    }
    return std::nullopt;
  }

  std::string_view body_;
  LineScanner lines_;
  std::string_view rest_;
  PlyFormat format_;
  std::uint64_t header_lines_;
  std::size_t position_ = 0;
};

// "line 17" in text, "vertex 41" in a binary file.
Error record_error(const PlyValues& values, std::string_view what, std::uint64_t record,
                   std::string_view message) {
  if (values.line() > 0) return line_error(values.line(), fmt::format("{} {}: {}", what, record, message));
  return invalid_input(fmt::format("{} {}: {}", what, record, message));
}

constexpr std::string_view kEndsHere = "the file ends here or has no number (truncated; export it again)";

Result<std::uint64_t> read_list_length(PlyValues& values, const PlyProperty& property,
                                       std::string_view element, std::uint64_t record) {
  const auto length = values.next(*property.count_type);
  if (!length) return record_error(values, element, record, kEndsHere);
  if (*length < 0 || *length != std::floor(*length) || *length > 4294967295.0) {
    return record_error(values, element, record, fmt::format("{} is not a length of a list", *length));
  }
  return static_cast<std::uint64_t>(*length);
}

Status skip_property(PlyValues& values, const PlyProperty& property, std::string_view element,
                     std::uint64_t record) {
  std::uint64_t count = 1;
  if (property.count_type) {
    const Result<std::uint64_t> length = read_list_length(values, property, element, record);
    if (!length.ok()) return length.error();
    count = *length;
  }
  if (!values.skip(property.type, count)) return record_error(values, element, record, kEndsHere);
  return ok_status();
}

// For each property 0, 1, 2 when it is red, green, blue, else -1; empty when not all three are there as
// uchar.
std::vector<int> colour_channels(const PlyElement& element) {
  static constexpr std::string_view kNames[] = {"red", "green", "blue"};
  std::vector<int> channel(element.properties.size(), -1);
  for (int k = 0; k < 3; ++k) {
    const auto place = element.find(kNames[k]);
    if (!place || element.properties[*place].count_type || element.properties[*place].type != PlyType::kUint8)
      return {};
    channel[*place] = k;
  }
  return channel;
}

Status read_vertices(const PlyElement& element, PlyValues& values, RunContext& context, PolygonSoup& soup) {
  std::vector<int> axis(element.properties.size(), -1);
  static constexpr std::string_view kNames[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    const auto place = element.find(kNames[k]);
    if (!place || element.properties[*place].count_type) {
      return invalid_input(fmt::format("the PLY vertices have no coordinate {}", kNames[k]));
    }
    axis[*place] = k;
  }
  const std::vector<int> channel = colour_channels(element);
  if (!channel.empty()) soup.colours.reserve(element.count);
  soup.vertices.reserve(element.count);
  for (std::uint64_t v = 0; v < element.count; ++v) {
    if (v % 65536 == 0 && context.cancelled()) return cancelled_error();
    Eigen::Vector3d p;
    if (!channel.empty()) soup.colours.emplace_back();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (!channel.empty() && channel[i] >= 0) {
        const auto value = values.next(property.type);
        if (!value) return record_error(values, "vertex", v, kEndsHere);
        if (*value < 0 || *value > 255)
          return record_error(values, "vertex", v, fmt::format("{} is no colour from 0 to 255", *value));
        soup.colours.back()[channel[i]] = static_cast<std::uint8_t>(*value);
        continue;
      }
      if (axis[i] < 0) {
        if (Status s = skip_property(values, property, "vertex", v); !s.ok()) return s;
        continue;
      }
      const auto value = values.next(property.type);
      if (!value) return record_error(values, "vertex", v, kEndsHere);
      if (!std::isfinite(*value)) {
        return record_error(values, "vertex", v, fmt::format("coordinate {} is not finite", property.name));
      }
      p[axis[i]] = *value;
    }
    soup.vertices.push_back(p);
  }
  return ok_status();
}

Status read_faces(const PlyElement& element, PlyValues& values, const ReadRequest& request,
                  PolygonSoup& soup) {
  auto list = element.find("vertex_indices");
  if (!list) list = element.find("vertex_index");
  if (!list || !element.properties[*list].count_type || !is_integer(element.properties[*list].type)) {
    return invalid_input("the PLY faces have no list of integers \"vertex_indices\"");
  }
  const std::uint64_t most = request.limits.max_polygon_corners;
  soup.faces.reserve(element.count);
  for (std::uint64_t f = 0; f < element.count; ++f) {
    if (f % 65536 == 0 && request.context.cancelled()) return cancelled_error();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (i != *list) {
        if (Status s = skip_property(values, property, "face", f); !s.ok()) return s;
        continue;
      }
      const Result<std::uint64_t> length = read_list_length(values, property, "face", f);
      if (!length.ok()) return length.error();
      if (*length > most) {
        return record_error(values, "face", f,
                            fmt::format("{} corners are more than the limit of {}", *length, most));
      }
      soup.faces.push_back({soup.corners.size(), *length, values.line()});
      for (std::uint64_t c = 0; c < *length; ++c) {
        const auto index = values.next(property.type);
        if (!index) return record_error(values, "face", f, kEndsHere);
        if (*index != std::floor(*index) || std::abs(*index) > 4294967295.0) {
          return record_error(values, "face", f, fmt::format("{} is not a vertex index", *index));
        }
        soup.corners.push_back(static_cast<std::int64_t>(*index));
      }
      if (Status s = check_count(soup.corners.size() / 3, request.limits.max_triangles, "triangles"); !s.ok())
        return s;
    }
  }
  return ok_status();
}

}  // namespace

Result<MeshFile> read_ply(const ReadRequest& request) {
  const Result<PlyHeader> header = read_ply_header(request.bytes);
  if (!header.ok()) return header.error();
  PlyValues values(request.bytes.substr(header->body_offset), header->format, header->line_count);
  PolygonSoup soup;
  for (const PlyElement& element : header->elements) {
    Status s = ok_status();
    if (element.name == "vertex" && soup.vertices.empty()) {
      s = check_count(element.count, request.limits.max_vertices, "vertices");
      if (s.ok()) s = read_vertices(element, values, request.context, soup);
    } else if (element.name == "face" && soup.faces.empty()) {
      s = check_count(element.count, request.limits.max_triangles, "faces");
      if (s.ok()) s = read_faces(element, values, request, soup);
    } else if (element.name == "tristrips") {
      return unsupported("PLY triangle strips are not read; export with faces, or as STL, OBJ or OFF");
    } else if (!element.properties.empty()) {
      for (std::uint64_t r = 0; r < element.count && s.ok(); ++r) {
        if (r % 65536 == 0 && request.context.cancelled()) return cancelled_error();
        for (const PlyProperty& property : element.properties) {
          s = skip_property(values, property, element.name.substr(0, 40), r);
          if (!s.ok()) break;
        }
      }
    }
    if (!s.ok()) return s.error();
  }
  auto file = finish(std::move(soup), "PLY", 0, request);
  if (file) file.value().comments = header->comments;
  return file;
}

}  // namespace skinframe
