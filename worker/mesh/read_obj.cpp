// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ: only "v" and "f" matter here; texture, normals, groups, materials, lines and curves are
// passed over. Indices count from 1; a negative one counts back from the last vertex read so far.
#include <fmt/format.h>

#include "worker/mesh/mesh_formats.h"
#include "worker/mesh/text_scanner.h"

namespace skinframe {
namespace {

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

// A logical line: physical lines that end with a backslash go on in the next one.
class ObjLines {
 public:
  explicit ObjLines(std::string_view text) : lines_(text) {}

  std::optional<std::string_view> next() {
    auto line = lines_.next();
    first_ = lines_.line_number();
    if (!line || !line->ends_with('\\')) return line;
    joined_.clear();
    while (line && line->ends_with('\\')) {
      joined_.append(line->substr(0, line->size() - 1)).push_back(' ');
      line = lines_.next();
    }
    if (line) joined_.append(*line);
    return joined_;
  }
  std::uint64_t line_number() const { return first_; }

 private:
  LineScanner lines_;
  std::string joined_;
  std::uint64_t first_ = 0;
};

Status add_vertex(std::string_view words, std::uint64_t line, PolygonSoup& soup) {
  Eigen::Vector3d p;
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = take_word(words);
    const auto value = parse_finite(word);
    if (!value) return line_error(line, fmt::format("{} is not a finite coordinate", quoted(word)));
    p[k] = *value;
  }
  soup.vertices.push_back(p);  // a weight or a colour may follow; neither moves the point
  return ok_status();
}

Status add_face(std::string_view words, std::uint64_t line, const ReadLimits& limits, PolygonSoup& soup) {
  PolygonSoup::Face face{soup.corners.size(), 0, line};
  for (std::string_view word = take_word(words); !word.empty(); word = take_word(words)) {
    const auto index = parse_integer(word.substr(0, word.find('/')));
    if (!index || *index == 0) return line_error(line, fmt::format("{} is not a vertex index", quoted(word)));
    const auto known = static_cast<std::int64_t>(soup.vertices.size());
    if (*index < -known) return line_error(line, fmt::format("index {} of {} vertices", *index, known));
    soup.corners.push_back(*index > 0 ? *index - 1 : known + *index);
    if (++face.count > limits.max_polygon_corners) {
      return line_error(line, fmt::format("a face of more than {} corners", limits.max_polygon_corners));
    }
  }
  soup.faces.push_back(face);
  return ok_status();
}

}  // namespace

Result<MeshFile> read_obj(const ReadRequest& request) {
  PolygonSoup soup;
  ObjLines lines(request.bytes);
  std::uint64_t read = 0;
  while (const auto line = lines.next()) {
    if (++read % 65536 == 0 && request.context.cancelled()) return cancelled_error();
    std::string_view words = without_comment(*line);
    const std::string_view keyword = take_word(words);
    if (keyword == "v") {
      if (Status s = add_vertex(words, lines.line_number(), soup); !s.ok()) return s.error();
      if (Status s = check_count(soup.vertices.size(), request.limits.max_vertices, "vertices"); !s.ok()) {
        return s.error();
      }
    } else if (keyword == "f" || keyword == "fo") {
      if (Status s = add_face(words, lines.line_number(), request.limits, soup); !s.ok()) return s.error();
      // Corners bound both faces and triangles: a triangle takes three.
      if (Status s = check_count(soup.corners.size() / 3, request.limits.max_triangles, "faces"); !s.ok()) {
        return s.error();
      }
    }
  }
  return finish(std::move(soup), "OBJ", 1, request);
}

}  // namespace skinframe
