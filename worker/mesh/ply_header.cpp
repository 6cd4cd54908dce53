// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/ply_header.h"

#include <fmt/format.h>

#include <array>

#include "worker/mesh/text_scanner.h"

namespace skinframe {
namespace {

std::optional<PlyType> parse_type(std::string_view name) {
  struct Name {
    std::string_view name;
    PlyType type;
  };
  static constexpr std::array<Name, 16> kNames = {{
      {"char", PlyType::kInt8},
      {"int8", PlyType::kInt8},
      {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},
      {"short", PlyType::kInt16},
      {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},
      {"uint16", PlyType::kUint16},
      {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},
      {"uint", PlyType::kUint32},
      {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat32},
      {"float32", PlyType::kFloat32},
      {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64},
  }};
  for (const auto& entry : kNames) {
    if (entry.name == name) return entry.type;
  }
  return std::nullopt;
}

Result<PlyFormat> parse_format(std::string_view words, std::uint64_t line) {
  const std::string_view name = take_word(words);
  if (name == "ascii") return PlyFormat::kAscii;
  if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (name == "binary_big_endian") return PlyFormat::kBigEndian;
  return line_error(line, fmt::format("{} is no PLY format", quoted(name)));
}

Result<PlyElement> parse_element(std::string_view words, std::uint64_t line) {
  PlyElement element;
  element.name = take_word(words);
  const std::string_view word = take_word(words);
  const auto count = parse_integer(word);
  if (element.name.empty() || !count || *count < 0) {
    return line_error(line, fmt::format("{} is not a count of elements", quoted(word)));
  }
  element.count = static_cast<std::uint64_t>(*count);
  return element;
}

Result<PlyProperty> parse_property(std::string_view words, std::uint64_t line) {
  PlyProperty property;
  std::string_view word = take_word(words);
  if (word == "list") {
    property.count_type = parse_type(take_word(words));
    if (!property.count_type || !is_integer(*property.count_type)) {
      return line_error(line, "a list's length needs an integer type");
    }
    word = take_word(words);
  }
  const auto type = parse_type(word);
  if (!type) return line_error(line, fmt::format("{} is no PLY type", quoted(word)));
  property.type = *type;
  property.name = take_word(words);
  if (property.name.empty()) return line_error(line, "a property without a name");
  return property;
}

Status check_counts(const PlyHeader& header, std::uint64_t body_bytes) {
  for (const PlyElement& element : header.elements) {
    const std::uint64_t least = element.least_record_bytes(header.format);
    if (least == 0 || element.count <= (body_bytes + 1) / least) continue;
    return invalid_input(
        fmt::format("{} elements {} are announced, at least {} bytes each, but only {} bytes follow "
                    "the header (truncated or a wrong count; export it again)",
                    element.count, quoted(element.name), least, body_bytes));
  }
  return ok_status();
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 0;
}

bool is_integer(PlyType type) { return type != PlyType::kFloat32 && type != PlyType::kFloat64; }

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  for (std::size_t p = 0; p < properties.size(); ++p) {
    if (properties[p].name == property) return p;
  }
  return std::nullopt;
}

std::uint64_t PlyElement::least_record_bytes(PlyFormat format) const {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : properties) {
    // In text every value takes a digit and a separator.
    bytes += format == PlyFormat::kAscii ? 2 : size_of(p.count_type.value_or(p.type));
  }
  return bytes;
}

Result<PlyHeader> read_ply_header(std::string_view bytes) {
  PlyHeader header;
  bool has_format = false;
  LineScanner lines(bytes);
  while (const auto line = lines.next()) {
    const std::uint64_t number = lines.line_number();
    std::string_view words = *line;
    const std::string_view keyword = take_word(words);
    if (keyword == "format") {
      const Result<PlyFormat> format = parse_format(words, number);
      if (!format.ok()) return format.error();
      header.format = *format;
      has_format = true;
    } else if (keyword == "element") {
      Result<PlyElement> element = parse_element(words, number);
      if (!element.ok()) return element.error();
      header.elements.push_back(std::move(element).value());
    } else if (keyword == "property") {
      if (header.elements.empty()) return line_error(number, "a property ahead of the first element");
      Result<PlyProperty> property = parse_property(words, number);
      if (!property.ok()) return property.error();
      header.elements.back().properties.push_back(std::move(property).value());
    } else if (keyword == "end_header") {
      if (!has_format) return line_error(number, "the header ends without a format");
      header.body_offset = lines.position();
      header.line_count = number;
      if (Status s = check_counts(header, bytes.size() - header.body_offset); !s.ok()) return s.error();
      return header;
    } else if (keyword == "comment") {
      if (header.comments.size() < kMostPlyComments)
        header.comments.emplace_back(trim(words).substr(0, kMostPlyCommentBytes));
    } else if (!keyword.empty() && keyword != "ply" && keyword != "obj_info") {
      return line_error(number, fmt::format("{} is no word of a PLY header", quoted(keyword)));
    }
  }
  return invalid_input("the PLY header has no \"end_header\" (truncated; export it again)");
}

}  // namespace skinframe
