// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/write_deformation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

namespace skinframe {
namespace {

void put(std::string& out, const Eigen::Vector3d& v) {
  for (int k = 0; k < 3; ++k) {
    const auto value = static_cast<float>(v[k]);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.append(bytes, sizeof value);
  }
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

Status write_deformation(const Verification& v, const Deformation& deformation,
                         const std::filesystem::path& path) {
  SKINFRAME_CHECK(deformation.displacement_mm.size() == v.skin_mm.size());
  double most = 0;
  for (const auto& d : deformation.displacement_mm) most = std::max(most, d.norm());
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment load {}\ncomment red is {:.6g} mm\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float displacement_x\nproperty float displacement_y\nproperty float displacement_z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      deformation.name, most, v.skin_mm.size(), v.skin_triangles.size());
  for (std::size_t i = 0; i < v.skin_mm.size(); ++i) {
    put(out, v.skin_mm[i]);
    const auto colour = colour_of(most > 0 ? deformation.displacement_mm[i].norm() / most : 0);
    out.append(reinterpret_cast<const char*>(colour.data()), colour.size());
    put(out, deformation.displacement_mm[i]);
  }
  for (const auto& triangle : v.skin_triangles) {
    out.push_back(3);
    for (const std::int32_t index : triangle) {
      char bytes[sizeof index];
      std::memcpy(bytes, &index, sizeof index);
      out.append(bytes, sizeof index);
    }
  }
  std::ofstream file(path, std::ios::binary);
  file.write(out.data(), static_cast<std::streamsize>(out.size()));
  file.close();
  if (!file) return io_error(fmt::format("{}: could not be written", path.string()));
  return ok_status();
}

}  // namespace skinframe
