// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/touching_boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>

#include "worker/skin/box_tree.h"

namespace skinframe {

std::vector<std::pair<int, int>> touching_pairs(const std::vector<Eigen::AlignedBox3f>& boxes,
                                                const std::function<bool(int, int)>& keep) {
  const BoxTree tree(boxes);
  std::mutex mutex;
  std::vector<std::pair<int, int>> found;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, boxes.size(), 1024), [&](const auto& range) {
    std::vector<std::pair<int, int>> here;
    tree.touching(static_cast<int>(range.begin()), static_cast<int>(range.end()), [&](int i, int j) {
      const auto [low, high] = std::minmax({i, j});
      if (keep(low, high)) here.emplace_back(low, high);
    });
    const std::lock_guard lock(mutex);
    found.insert(found.end(), here.begin(), here.end());
  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace skinframe
