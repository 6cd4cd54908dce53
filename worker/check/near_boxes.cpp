// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/near_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace skinframe::check {
namespace {

constexpr double kMostPlaces = 2e7;
constexpr double kMostColumns = 1000.0;  // each way

// Columns of one width about all boxes; a box covers those from first to last, each way.
class Columns {
 public:
  Columns(const std::vector<Eigen::AlignedBox3d>& boxes) {
    Eigen::AlignedBox3d all;
    double sizes = 0.0;
    for (const auto& box : boxes) {
      all.extend(box);
      sizes += box.sizes().tail<2>().maxCoeff();
    }
    low_ = all.min().tail<2>();
    const double extent = std::max(1e-9, all.sizes().tail<2>().maxCoeff());
    width_ = std::max(2.0 * sizes / static_cast<double>(boxes.size()), extent / kMostColumns);
    while (places(boxes) > kMostPlaces) width_ *= 2.0;
    const Eigen::Vector2d top = all.max().tail<2>();
    counts_ = {column(top, 0) + 1, column(top, 1) + 1};
  }

  int column(const Eigen::Vector2d& p, int axis) const {
    return static_cast<int>((p[axis] - low_[axis]) / width_);
  }
  std::array<int, 4> covered(const Eigen::AlignedBox3d& box) const {
    const Eigen::Vector2d low = box.min().tail<2>(), high = box.max().tail<2>();
    return {column(low, 0), column(high, 0), column(low, 1), column(high, 1)};
  }
  std::size_t count() const { return static_cast<std::size_t>(counts_[0]) * counts_[1]; }
  std::size_t number(int y, int z) const { return static_cast<std::size_t>(y) * counts_[1] + z; }

 private:
  double places(const std::vector<Eigen::AlignedBox3d>& boxes) const {
    double sum = 0.0;
    for (const auto& box : boxes) {
      const auto [y0, y1, z0, z1] = covered(box);
      sum += (y1 - y0 + 1.0) * (z1 - z0 + 1.0);
    }
    return sum;
  }

  Eigen::Vector2d low_;
  double width_ = 1.0;
  std::array<int, 2> counts_{};
};

}  // namespace

void for_each_overlap(const std::vector<Eigen::AlignedBox3d>& boxes,
                      const std::function<void(int, int)>& visit) {
  if (boxes.empty()) return;
  const Columns columns(boxes);
  const auto for_each_column = [&](int i, const auto& act) {
    const auto [y0, y1, z0, z1] = columns.covered(boxes[i]);
    for (int y = y0; y <= y1; ++y)
      for (int z = z0; z <= z1; ++z) act(columns.number(y, z));
  };
  // In order of the lower end along x, so that each column's list is in that order too.
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const double a = boxes[i].min().x(), b = boxes[j].min().x();
    return a != b ? a < b : i < j;
  });
  std::vector<std::uint32_t> first(columns.count() + 1, 0);
  for (int i : order) for_each_column(i, [&](std::size_t c) { ++first[c + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> listed(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (int i : order) for_each_column(i, [&](std::size_t c) { listed[next[c]++] = i; });

  for (std::size_t c = 0; c + 1 < first.size(); ++c) {
    for (std::uint32_t a = first[c]; a < first[c + 1]; ++a) {
      const auto& box = boxes[listed[a]];
      for (std::uint32_t b = a + 1; b < first[c + 1]; ++b) {
        const auto& other = boxes[listed[b]];
        if (other.min().x() > box.max().x()) break;
        if (!box.intersects(other)) continue;
        // Two boxes may stand in several columns together: this pair is told in the first of them.
        const Eigen::Vector2d corner = box.min().cwiseMax(other.min()).tail<2>();
        if (columns.number(columns.column(corner, 0), columns.column(corner, 1)) != c) continue;
        visit(std::min(listed[a], listed[b]), std::max(listed[a], listed[b]));
      }
    }
  }
}

}  // namespace skinframe::check
