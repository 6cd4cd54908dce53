// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/half_edges.h"

#include <algorithm>

namespace skinframe {
namespace {

std::uint64_t edge_key(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
}

}  // namespace

EdgeTable::EdgeTable(const TriangleMesh& mesh) {
  const std::size_t count = 3 * mesh.triangles.size();
  std::vector<std::pair<std::uint64_t, int>> uses(count);
  for (std::size_t h = 0; h < count; ++h) {
    const int half_edge = static_cast<int>(h);
    uses[h] = {edge_key(origin_of(mesh, half_edge), target_of(mesh, half_edge)), half_edge};
  }
  std::sort(uses.begin(), uses.end());
  half_edges_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || uses[i].first != uses[i - 1].first) {
      starts_.push_back(i);
    }
    half_edges_.push_back(uses[i].second);
  }
  starts_.push_back(count);
}

}  // namespace skinframe
