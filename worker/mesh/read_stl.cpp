// SPDX-License-Identifier: GPL-3.0-or-later
// STL: triangles without shared vertices; corners equal to the last bit are joined while reading.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "worker/mesh/mesh_formats.h"
#include "worker/mesh/text_scanner.h"

namespace skinframe {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of text, 4 of count
constexpr std::size_t kFacetBytes = 50;   // normal, three corners, 2 of attributes

static_assert(std::endian::native == std::endian::little,
              "binary STL is read and written as it lies in memory");

// Gives equal points one number.
class CornerTable {
 public:
  explicit CornerTable(std::vector<Eigen::Vector3d>& vertices) : vertices_(vertices) {}

  int add(const Eigen::Vector3d& point) {
    const Eigen::Vector3d p = point + Eigen::Vector3d::Zero();  // -0 becomes +0
    const auto [place, is_new] = numbers_.try_emplace(p, static_cast<int>(vertices_.size()));
    if (is_new) vertices_.push_back(p);
    return place->second;
  }

 private:
  struct Hash {
    std::size_t operator()(const Eigen::Vector3d& p) const {
      std::uint64_t hash = 0x9E3779B97F4A7C15u;
      for (int i = 0; i < 3; ++i) {
        hash ^= std::bit_cast<std::uint64_t>(p[i]);
        hash *= 0xFF51AFD7ED558CCDu;
        hash ^= hash >> 32;
      }
      return hash;
    }
  };
  std::vector<Eigen::Vector3d>& vertices_;
  std::unordered_map<Eigen::Vector3d, int, Hash> numbers_;
};

Error count_error(std::uint32_t count, std::size_t bytes) {
  return invalid_input(fmt::format(
      "the header announces {} triangles, {} bytes; the file has {} bytes, room for {} (truncated or a "
      "wrong count; export it again)",
      count, kHeaderBytes + kFacetBytes * std::uint64_t{count}, bytes, (bytes - kHeaderBytes) / kFacetBytes));
}

}  // namespace

std::optional<std::uint32_t> announced_stl_triangles(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) return std::nullopt;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

bool is_exact_binary_stl(std::string_view bytes) {
  const auto count = announced_stl_triangles(bytes);
  return count && bytes.size() == kHeaderBytes + kFacetBytes * std::uint64_t{*count};
}

Result<MeshFile> read_binary_stl(const ReadRequest& request) {
  const std::uint32_t count = announced_stl_triangles(request.bytes).value_or(0);
  const std::uint64_t expected = kHeaderBytes + kFacetBytes * std::uint64_t{count};
  // A few bytes behind the last facet are padding of some exporters; a whole facet is a wrong count.
  if (request.bytes.size() < expected || request.bytes.size() >= expected + kFacetBytes) {
    return count_error(count, request.bytes.size());
  }
  if (count == 0) return invalid_input("the STL file holds no triangle");
  if (Status s = check_count(count, request.limits.max_triangles, "triangles"); !s.ok()) return s.error();

  MeshFile file;
  file.format = "STL (binary)";
  file.mesh.triangles.reserve(count);
  CornerTable corners(file.mesh.vertices);
  for (std::uint32_t t = 0; t < count; ++t) {
    if (t % 65536 == 0 && request.context.cancelled()) return cancelled_error();
    float values[9];
    std::memcpy(values, request.bytes.data() + kHeaderBytes + kFacetBytes * t + 12, sizeof values);
    std::array<int, 3> triangle{};
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d p(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
      if (!p.allFinite()) {
        return invalid_input(
            fmt::format("triangle {}: corner {} is not finite ({}, {}, {})", t, k, p.x(), p.y(), p.z()));
      }
      triangle[k] = corners.add(p);
    }
    file.mesh.triangles.push_back(triangle);
  }
  if (Status s = check_count(file.mesh.vertices.size(), request.limits.max_vertices, "vertices"); !s.ok()) {
    return s.error();
  }
  if (request.bytes.size() > expected) {
    file.notes.push_back(
        fmt::format("ignored {} bytes behind the last triangle", request.bytes.size() - expected));
  }
  return file;
}

// Reads "vertex x y z" lines between "outer loop" and "endloop"; the normals are computed from the corners
// where they are needed, so "facet normal" is not looked at.
Result<MeshFile> read_ascii_stl(const ReadRequest& request) {
  MeshFile file;
  file.format = "STL (ASCII)";
  CornerTable corners(file.mesh.vertices);
  std::array<int, 3> triangle{};
  int corner = -1;  // within a loop; -1 outside
  bool in_solid = false;
  LineScanner lines(request.bytes);
  while (const auto line = lines.next()) {
    const std::uint64_t number = lines.line_number();
    if (number % 65536 == 0 && request.context.cancelled()) return cancelled_error();
    std::string_view words = *line;
    const std::string_view keyword = take_word(words);
    if (keyword.empty()) continue;
    if (equal_ignoring_case(keyword, "vertex")) {
      if (corner < 0) return line_error(number, "a vertex outside of a loop");
      if (corner > 2) return line_error(number, "a facet with more than three vertices");
      Eigen::Vector3d p;
      for (int k = 0; k < 3; ++k) {
        const std::string_view word = take_word(words);
        const auto value = parse_finite(word);
        if (!value) return line_error(number, fmt::format("{} is not a finite coordinate", quoted(word)));
        p[k] = *value;
      }
      triangle[corner++] = corners.add(p);
    } else if (equal_ignoring_case(keyword, "outer")) {
      if (!in_solid || corner >= 0)
        return line_error(number, "a loop inside of a loop or outside of a solid");
      corner = 0;
    } else if (equal_ignoring_case(keyword, "endloop")) {
      if (corner != 3)
        return line_error(number, fmt::format("a facet of {} vertices", corner < 0 ? 0 : corner));
      file.mesh.triangles.push_back(triangle);
      corner = -1;
      if (Status s = check_count(file.mesh.triangles.size(), request.limits.max_triangles, "triangles");
          !s.ok()) {
        return s.error();
      }
    } else if (equal_ignoring_case(keyword, "solid")) {
      in_solid = true;
    } else if (equal_ignoring_case(keyword, "endsolid")) {
      if (corner >= 0) return line_error(number, "the solid ends inside of a facet");
      in_solid = false;
    } else if (!equal_ignoring_case(keyword, "facet") && !equal_ignoring_case(keyword, "endfacet") &&
               !equal_ignoring_case(keyword, "color")) {
      return line_error(number, fmt::format("{} is no word of an ASCII STL", quoted(keyword)));
    }
  }
  if (in_solid) {
    return line_error(lines.line_number(),
                      fmt::format("the file ends without \"endsolid\" after {} triangles "
                                  "(truncated; export it again)",
                                  file.mesh.triangles.size()));
  }
  if (file.mesh.triangles.empty()) return invalid_input("the STL file holds no triangle");
  if (Status s = check_count(file.mesh.vertices.size(), request.limits.max_vertices, "vertices"); !s.ok()) {
    return s.error();
  }
  return file;
}

}  // namespace skinframe
