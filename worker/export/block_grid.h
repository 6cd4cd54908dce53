// SPDX-License-Identifier: GPL-3.0-or-later
// Which triangles are near: a uniform grid over a box, for triangles that change while it is asked.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace skinframe {

class BlockGrid {
 public:
  BlockGrid(const Eigen::AlignedBox3d& box, double cell_mm, std::size_t triangles)
      : low_(box.min()), covered_(triangles) {
    cell_mm = std::max(cell_mm, box.sizes().maxCoeff() / kMostCells);
    inverse_ = 1.0 / cell_mm;
    for (int k = 0; k < 3; ++k) cells_[k] = 1 + static_cast<int>(box.sizes()[k] * inverse_);
    first_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2], -1);
  }

  // Also for a triangle that has changed: where it was before it stays listed.
  void insert(int triangle, const Eigen::AlignedBox3d& box) {
    const Range range = range_of(box);
    Range& known = covered_[triangle];
    if (known.holds(range)) return;
    for_each(range, [&](int x, int y, int z) {
      if (known.holds(x, y, z)) return;
      int& first = first_[index(x, y, z)];
      entries_.push_back({triangle, first});
      first = static_cast<int>(entries_.size()) - 1;
    });
    known = range;  // listed in full; entries in cells that it left stay, and do no harm
  }

  // visit(triangle) -> false takes the entry out for good. A triangle may be visited more than once.
  template <class Visit>
  void near(const Eigen::AlignedBox3d& box, Visit visit) {
    for_each(range_of(box), [&](int x, int y, int z) {
      int* link = &first_[index(x, y, z)];
      while (*link >= 0) {
        Entry& entry = entries_[*link];
        if (visit(entry.triangle))
          link = &entry.next;
        else
          *link = entry.next;
      }
    });
  }

 private:
  static constexpr int kMostCells = 96;  // across the box

  struct Entry {
    int triangle, next;
  };
  struct Range {
    std::array<short, 3> low{1, 1, 1}, high{0, 0, 0};  // empty
    bool holds(int x, int y, int z) const {
      return x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1] && z >= low[2] && z <= high[2];
    }
    bool holds(const Range& r) const {
      return holds(r.low[0], r.low[1], r.low[2]) && holds(r.high[0], r.high[1], r.high[2]);
    }
  };

  Range range_of(const Eigen::AlignedBox3d& box) const {
    Range range;
    for (int k = 0; k < 3; ++k) {
      const auto cell = [&](double x) {
        return static_cast<short>(std::clamp((x - low_[k]) * inverse_, 0.0, cells_[k] - 1.0));
      };
      range.low[k] = cell(box.min()[k]);
      range.high[k] = cell(box.max()[k]);
    }
    return range;
  }
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(x) * cells_[1] + y) * cells_[2] + z;
  }
  template <class Visit>
  static void for_each(const Range& range, Visit visit) {
    for (int x = range.low[0]; x <= range.high[0]; ++x)
      for (int y = range.low[1]; y <= range.high[1]; ++y)
        for (int z = range.low[2]; z <= range.high[2]; ++z) visit(x, y, z);
  }

  Eigen::Vector3d low_;
  double inverse_ = 1.0;
  std::array<int, 3> cells_{};
  std::vector<int> first_;
  std::vector<Entry> entries_;
  std::vector<Range> covered_;
};

}  // namespace skinframe
