// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/package.h"

#include <fmt/format.h>
#include <unzip.h>

#include <charconv>
#include <memory>
#include <optional>
#include <string_view>

namespace skinframe::check {
namespace {

constexpr std::size_t kMostModelBytes = std::size_t{1} << 31;
constexpr const char* kModel = "3D/3dmodel.model";

Result<std::string> read_model(const std::filesystem::path& path) {
  const auto close = [](void* file) { unzClose(file); };
  const std::unique_ptr<void, decltype(close)> file(unzOpen64(path.c_str()), close);
  if (!file) return io_error(fmt::format("{}: cannot be opened as a package", path.string()));
  if (unzLocateFile(file.get(), kModel, 1) != UNZ_OK || unzOpenCurrentFile(file.get()) != UNZ_OK)
    return invalid_input(fmt::format("{}: no {} in it", path.string(), kModel));
  std::string text;
  std::vector<char> chunk(1 << 20);
  for (;;) {
    const int got = unzReadCurrentFile(file.get(), chunk.data(), static_cast<unsigned>(chunk.size()));
    if (got < 0) return invalid_input(fmt::format("{}: {} is damaged", path.string(), kModel));
    if (got == 0) break;
    text.append(chunk.data(), static_cast<std::size_t>(got));
    if (text.size() > kMostModelBytes)
      return invalid_input(fmt::format("{}: more than {} bytes", path.string(), kMostModelBytes));
  }
  if (unzCloseCurrentFile(file.get()) != UNZ_OK)
    return invalid_input(fmt::format("{}: {} does not have its check sum", path.string(), kModel));
  return text;
}

std::optional<std::string_view> attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    if (at == 0 || tag[at - 1] != ' ' || tag.substr(at + name.size(), 2) != "=\"") continue;
    const std::size_t from = at + name.size() + 2, to = tag.find('"', from);
    if (to != std::string_view::npos) return tag.substr(from, to - from);
  }
  return std::nullopt;
}

template <class Number>
bool number(std::string_view tag, std::string_view name, Number* value) {
  const auto text = attribute(tag, name);
  if (!text) return false;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), *value);
  return error == std::errc() && end == text->data() + text->size();
}

// One element; false when it lacks what it needs.
bool take(std::string_view name, std::string_view tag, Package* out) {
  if (name == "model") {
    out->unit = attribute(tag, "unit").value_or("");
    out->required_extensions = attribute(tag, "requiredextensions").value_or("");
  } else if (name == "object") {
    out->object_name = attribute(tag, "name").value_or("");
  } else if (name == "vertex") {
    Eigen::Vector3d v;
    if (!number(tag, "x", &v.x()) || !number(tag, "y", &v.y()) || !number(tag, "z", &v.z())) return false;
    out->mesh.vertices.push_back(v);
  } else if (name == "triangle") {
    std::array<int, 3> t{};
    if (!number(tag, "v1", &t[0]) || !number(tag, "v2", &t[1]) || !number(tag, "v3", &t[2])) return false;
    out->mesh.triangles.push_back(t);
  } else if (name == "b:beam") {
    Beam beam;
    if (!number(tag, "v1", &beam.a) || !number(tag, "v2", &beam.b) || !number(tag, "r1", &beam.radius_a_mm) ||
        !number(tag, "r2", &beam.radius_b_mm))
      return false;
    out->beams.push_back(beam);
  }
  return true;
}

}  // namespace

Result<Package> read_package(const std::filesystem::path& path) {
  auto text = read_model(path);
  if (!text) return text.error();
  Package package;
  const std::string_view whole = text.value();
  for (std::size_t at = whole.find('<'); at != std::string_view::npos; at = whole.find('<', at + 1)) {
    const std::size_t end = whole.find('>', at);
    if (end == std::string_view::npos)
      return invalid_input(fmt::format("{}: an element is cut off", path.string()));
    const std::string_view tag = whole.substr(at + 1, end - at - 1);
    const std::string_view name = tag.substr(0, tag.find_first_of(" \n/"));
    if (!take(name, tag, &package))
      return invalid_input(fmt::format("{}: <{}> lacks an attribute", path.string(), tag));
    at = end;
  }
  const int count = static_cast<int>(package.mesh.vertices.size());
  const auto known = [&](int v) { return v >= 0 && v < count; };
  for (const auto& [a, b, c] : package.mesh.triangles)
    if (!known(a) || !known(b) || !known(c))
      return invalid_input(fmt::format("{}: a triangle names a vertex that is not there", path.string()));
  for (const Beam& beam : package.beams)
    if (!known(beam.a) || !known(beam.b))
      return invalid_input(fmt::format("{}: a beam names a vertex that is not there", path.string()));
  return package;
}

}  // namespace skinframe::check
