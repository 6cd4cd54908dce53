// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/touching_boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <mutex>

namespace skinframe {
namespace {

namespace geometry = boost::geometry;
namespace index = boost::geometry::index;
using Point = geometry::model::point<float, 3, geometry::cs::cartesian>;
using Box = geometry::model::box<Point>;
using Item = std::pair<Box, int>;
using Tree = index::rtree<Item, index::quadratic<16>>;

Point point(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

std::vector<std::pair<int, int>> touching_pairs(const std::vector<Eigen::AlignedBox3f>& boxes,
                                                const std::function<bool(int, int)>& keep) {
  std::vector<Item> items;
  items.reserve(boxes.size());
  for (const auto& box : boxes)
    items.emplace_back(Box(point(box.min()), point(box.max())), static_cast<int>(items.size()));
  const Tree tree(items);
  std::mutex mutex;
  std::vector<std::pair<int, int>> found;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, items.size(), 1024), [&](const auto& range) {
    std::vector<std::pair<int, int>> here;
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const int i = items[k].second;
      for (auto at = tree.qbegin(index::intersects(items[k].first)); at != tree.qend(); ++at)
        if (i < at->second && keep(i, at->second)) here.emplace_back(i, at->second);
    }
    const std::lock_guard lock(mutex);
    found.insert(found.end(), here.begin(), here.end());
  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace skinframe
