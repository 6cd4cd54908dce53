// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/coloured_skin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

namespace skinframe {
namespace {

template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

std::string header_of(const Verification& v, const ColouredSkin& coloured) {
  std::string out = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : coloured.comments) out += "comment " + comment + "\n";
  out += fmt::format(
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n",
      v.skin_mm.size());
  for (const std::string& name : coloured.names) out += "property float " + name + "\n";
  return out + fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                           v.skin_triangles.size());
}

}  // namespace

std::array<unsigned char, 3> colour_of(double share) {
  constexpr double kRamp[4][3] = {{0, 0, 255}, {0, 255, 255}, {255, 255, 0}, {255, 0, 0}};
  const double at = 3 * std::clamp(share, 0.0, 1.0);
  const int from = std::min(2, static_cast<int>(at));
  std::array<unsigned char, 3> colour{};
  for (int k = 0; k < 3; ++k)
    colour[k] = static_cast<unsigned char>(
        std::lround(kRamp[from][k] + (at - from) * (kRamp[from + 1][k] - kRamp[from][k])));
  return colour;
}

Status write_coloured_skin(const Verification& v, const ColouredSkin& coloured,
                           const std::filesystem::path& path) {
  SKINFRAME_CHECK(coloured.figures.size() == v.skin_mm.size() && coloured.shares.size() == v.skin_mm.size());
  std::string out = header_of(v, coloured);
  for (std::size_t i = 0; i < v.skin_mm.size(); ++i) {
    for (int k = 0; k < 3; ++k) put(out, static_cast<float>(v.skin_mm[i][k]));
    for (const unsigned char part : colour_of(coloured.shares[i])) put(out, part);
    for (const double figure : coloured.figures[i]) put(out, static_cast<float>(figure));
  }
  for (const auto& triangle : v.skin_triangles) {
    out.push_back(3);
    for (const std::int32_t index : triangle) put(out, index);
  }
  std::ofstream file(path, std::ios::binary);
  file.write(out.data(), static_cast<std::streamsize>(out.size()));
  file.close();
  if (!file) return io_error(fmt::format("{}: could not be written", path.string()));
  return ok_status();
}

}  // namespace skinframe
