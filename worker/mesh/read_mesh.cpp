// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/read_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <system_error>

#include "worker/mesh/mesh_formats.h"
#include "worker/mesh/text_scanner.h"

namespace skinframe {
namespace {

constexpr std::string_view kZipMagics[] = {"PK\x03\x04", "PK\x05\x06"};  // the second: without entries
// Text is looked at this far: long enough for a licence in comments ahead of the first keyword.
constexpr std::size_t kSniffedBytes = std::size_t{1} << 16;

Result<std::string> load(const std::filesystem::path& path, const ReadLimits& limits, RunContext& context) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) return io_error(fmt::format("{}: no such file", path.string()));
  if (!std::filesystem::is_regular_file(status))
    return io_error(fmt::format("{}: not a file", path.string()));
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code) return io_error(fmt::format("{}: {}", path.string(), code.message()));
  if (size > limits.max_file_bytes) {
    return invalid_input(fmt::format("{}: {} bytes are more than the limit of {}; simplify the mesh",
                                     path.string(), size, limits.max_file_bytes));
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return io_error(fmt::format("{}: {}", path.string(), std::strerror(errno)));
  std::string bytes(size, '\0');
  constexpr std::size_t kChunk = std::size_t{1} << 24;
  std::size_t done = 0;
  while (done < bytes.size()) {
    if (context.cancelled()) return cancelled_error();
    const std::size_t got =
        std::fread(bytes.data() + done, 1, std::min(kChunk, bytes.size() - done), file.get());
    if (got == 0) break;
    done += got;
  }
  if (done < bytes.size()) {
    return io_error(fmt::format("{}: only {} of {} bytes could be read", path.string(), done, bytes.size()));
  }
  return bytes;
}

bool looks_like_text(std::string_view head) {
  return std::none_of(head.begin(), head.end(), [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f' && c != '\v';
  });
}

// "solid" is no proof: binary files begin with it too, and OBJ files may hold a line "solid ...".
bool looks_like_ascii_stl(std::string_view head) {
  std::string_view rest = head;
  if (!equal_ignoring_case(take_word(rest), "solid")) return false;
  LineScanner lines(head);
  lines.next();
  while (const auto line = lines.next()) {
    std::string_view words = *line;
    const std::string_view word = take_word(words);
    if (!word.empty()) return equal_ignoring_case(word, "facet") || equal_ignoring_case(word, "endsolid");
  }
  return true;  // nothing but its first line: the STL reader says what is missing
}

bool looks_like_off(std::string_view head) {
  LineScanner lines(head);
  while (const auto line = lines.next()) {
    std::string_view words = *line;
    const std::string_view word = take_word(words);
    if (word.empty() || word.front() == '#') continue;
    return word.size() >= 3 && word.size() <= 6 && word.substr(word.size() - 3) == "OFF";
  }
  return false;
}

bool looks_like_obj(std::string_view head) {
  static constexpr std::string_view kKeywords[] = {"v", "vt", "vn", "vp",     "f",     "o",
                                                   "g", "s",  "l",  "mtllib", "usemtl"};
  LineScanner lines(head);
  while (const auto line = lines.next()) {
    std::string_view words = *line;
    const std::string_view word = take_word(words);
    if (word.empty() || word.front() == '#') continue;
    return std::find(std::begin(kKeywords), std::end(kKeywords), word) != std::end(kKeywords);
  }
  return false;
}

Result<MeshFile> read_by_content(const ReadRequest& request) {
  const std::string_view bytes = request.bytes;
  const std::string_view head = bytes.substr(0, kSniffedBytes);
  if (bytes.empty()) return invalid_input("the file is empty (0 bytes)");
  for (const std::string_view magic : kZipMagics) {
    if (bytes.starts_with(magic)) return read_3mf(request);
  }
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return read_ply(request);
  if (is_exact_binary_stl(bytes)) return read_binary_stl(request);
  if (looks_like_off(head)) return read_off(request);
  if (looks_like_text(head)) {
    if (looks_like_ascii_stl(head)) return read_ascii_stl(request);
    if (looks_like_obj(head)) return read_obj(request);
    return invalid_input("the text is neither ASCII STL, OBJ, PLY nor OFF; export the mesh as one of these");
  }
  if (announced_stl_triangles(bytes)) return read_binary_stl(request);  // which says what does not agree
  return invalid_input(fmt::format(
      "{} bytes are neither STL, OBJ, PLY, OFF nor 3MF; export the mesh as one of these", bytes.size()));
}

}  // namespace

Status ReadLimits::validate() const {
  constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
  if (max_vertices > kMost || max_triangles > kMost) {
    return invalid_input(fmt::format("max_vertices and max_triangles cannot exceed {}", kMost));
  }
  if (max_polygon_corners < 3) return invalid_input("max_polygon_corners cannot be below 3");
  return ok_status();
}

Result<MeshFile> read_mesh_bytes(std::string_view bytes, const ReadLimits& limits, RunContext& context) {
  if (Status s = limits.validate(); !s.ok()) return s.error();
  if (bytes.size() > limits.max_file_bytes) {
    return invalid_input(fmt::format("{} bytes are more than the limit of {}; simplify the mesh",
                                     bytes.size(), limits.max_file_bytes));
  }
  return read_by_content({bytes, limits, context});
}

Result<MeshFile> read_mesh(const std::filesystem::path& path, const ReadLimits& limits, RunContext& context) {
  if (Status s = limits.validate(); !s.ok()) return s.error();
  try {
    Result<std::string> bytes = load(path, limits, context);
    if (!bytes.ok()) return bytes.error();
    Result<MeshFile> file = read_mesh_bytes(*bytes, limits, context);
    if (file.ok() || file.error().kind == ErrorKind::kCancelled) return file;
    return Error{file.error().kind, fmt::format("{}: {}", path.filename().string(), file.error().message)};
  } catch (const std::bad_alloc&) {
    return internal_error(fmt::format("{}: not enough memory to read the mesh", path.filename().string()));
  }
}

}  // namespace skinframe
