// SPDX-License-Identifier: GPL-3.0-or-later
// OFF (Geomview): "OFF", counts, one vertex a line, one face a line; normals and colours behind the three
// coordinates or the indices are passed over; # begins a comment.
#include <fmt/format.h>

#include "worker/mesh/mesh_formats.h"
#include "worker/mesh/text_scanner.h"

namespace skinframe {
namespace {

// Lines that hold something beside a comment.
class OffLines {
 public:
  explicit OffLines(std::string_view text) : lines_(text) {}

  std::optional<std::string_view> next() {
    while (const auto line = lines_.next()) {
      const std::string_view content = trim(line->substr(0, line->find('#')));
      if (!content.empty()) return content;
    }
    return std::nullopt;
  }
  std::uint64_t line_number() const { return lines_.line_number(); }

 private:
  LineScanner lines_;
};

Error ends_early(const OffLines& lines, std::string_view what, std::uint64_t read, std::uint64_t announced) {
  return line_error(
      lines.line_number(),
      fmt::format("the file ends after {} of {} {} (truncated; export it again)", read, announced, what));
}

struct Counts {
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
};

Result<Counts> read_header(OffLines& lines, const ReadRequest& request) {
  std::string_view words = lines.next().value_or("");
  const std::string_view keyword = take_word(words);
  if (keyword != "OFF" && keyword != "COFF" && keyword != "NOFF" && keyword != "CNOFF") {
    return unsupported(
        fmt::format("the OFF variant {} is not read; export as plain OFF, STL, OBJ or PLY", quoted(keyword)));
  }
  std::string_view word = take_word(words);
  if (word == "BINARY") return unsupported("binary OFF is not read; export as text OFF, STL, OBJ or PLY");
  if (word.empty()) {
    words = lines.next().value_or("");
    word = take_word(words);
  }
  const auto vertices = parse_integer(word);
  const auto faces = parse_integer(take_word(words));
  if (!vertices || !faces || *vertices < 0 || *faces < 0) {
    return line_error(lines.line_number(), "two counts, of vertices and of faces, are expected here");
  }
  const Counts counts{static_cast<std::uint64_t>(*vertices), static_cast<std::uint64_t>(*faces)};
  // The shortest line of a vertex is "0 0 0", of a face "0", each with its end: no count can be larger.
  if (counts.vertices > request.bytes.size() / 5 || counts.faces > request.bytes.size()) {
    return invalid_input(fmt::format("{} vertices and {} faces are announced, but the file has only {} bytes",
                                     counts.vertices, counts.faces, request.bytes.size()));
  }
  if (Status s = check_count(counts.vertices, request.limits.max_vertices, "vertices"); !s.ok())
    return s.error();
  if (Status s = check_count(counts.faces, request.limits.max_triangles, "faces"); !s.ok()) return s.error();
  return counts;
}

}  // namespace

Result<MeshFile> read_off(const ReadRequest& request) {
  OffLines lines(request.bytes);
  const Result<Counts> counts = read_header(lines, request);
  if (!counts.ok()) return counts.error();

  PolygonSoup soup;
  soup.vertices.reserve(counts->vertices);
  for (std::uint64_t v = 0; v < counts->vertices; ++v) {
    if (v % 65536 == 0 && request.context.cancelled()) return cancelled_error();
    auto line = lines.next();
    if (!line) return ends_early(lines, "vertices", v, counts->vertices);
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = take_word(*line);
      const auto value = parse_finite(word);
      if (!value) {
        return line_error(lines.line_number(), fmt::format("{} is not a finite coordinate", quoted(word)));
      }
      p[k] = *value;
    }
    soup.vertices.push_back(p);
  }
  soup.faces.reserve(counts->faces);
  for (std::uint64_t f = 0; f < counts->faces; ++f) {
    if (f % 65536 == 0 && request.context.cancelled()) return cancelled_error();
    auto line = lines.next();
    if (!line) return ends_early(lines, "faces", f, counts->faces);
    const auto corners = parse_integer(take_word(*line));
    if (!corners || *corners < 0 ||
        static_cast<std::uint64_t>(*corners) > request.limits.max_polygon_corners) {
      return line_error(lines.line_number(),
                        fmt::format("a face has 0 to {} corners", request.limits.max_polygon_corners));
    }
    PolygonSoup::Face face{soup.corners.size(), static_cast<std::uint64_t>(*corners), lines.line_number()};
    for (std::int64_t c = 0; c < *corners; ++c) {
      const std::string_view word = take_word(*line);
      const auto index = parse_integer(word);
      if (!index)
        return line_error(lines.line_number(), fmt::format("{} is not a vertex index", quoted(word)));
      soup.corners.push_back(*index);
    }
    soup.faces.push_back(face);
  }
  return finish(std::move(soup), "OFF", 0, request);
}

}  // namespace skinframe
