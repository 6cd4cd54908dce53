// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/front_schedule.h"

#include <algorithm>
#include <numeric>

namespace skinframe {
namespace {

// A subtree with more than this share of a lane's work is divided.
constexpr double kLargestShare = 0.5;
constexpr int kMostDivisions = 64;

std::vector<double> subtree_work(const std::vector<Front>& fronts) {
  std::vector<double> work(fronts.size());
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    work[f] += fronts[f].work();
    if (fronts[f].parent >= 0) work[fronts[f].parent] += work[f];
  }
  return work;
}

// Roots of disjoint subtrees, the heaviest first.
std::vector<int> divide(const std::vector<Front>& fronts, const std::vector<double>& work) {
  std::vector<int> roots;
  for (std::size_t f = 0; f < fronts.size(); ++f)
    if (fronts[f].parent < 0) roots.push_back(static_cast<int>(f));
  const auto heavier = [&](int a, int b) { return work[a] != work[b] ? work[a] > work[b] : a < b; };
  for (int division = 0; division < kMostDivisions; ++division) {
    std::sort(roots.begin(), roots.end(), heavier);
    const double all =
        std::accumulate(roots.begin(), roots.end(), 0.0, [&](double sum, int f) { return sum + work[f]; });
    if (roots.empty() || work[roots.front()] <= kLargestShare * all / kLanes) break;
    const std::vector<int>& children = fronts[roots.front()].children;
    roots.erase(roots.begin());
    roots.insert(roots.end(), children.begin(), children.end());
  }
  std::sort(roots.begin(), roots.end(), heavier);
  return roots;
}

void deal(const std::vector<int>& roots, const std::vector<double>& work, std::vector<int>& lane_of) {
  std::vector<double> load(kLanes, 0);
  for (int root : roots) {
    const auto lightest = std::min_element(load.begin(), load.end());
    lane_of[root] = static_cast<int>(lightest - load.begin());
    *lightest += work[root];
  }
}

// Walks a list of fronts as the factorisation does, noting where each update matrix stands.
class Arena {
 public:
  Arena(const std::vector<Front>& fronts, const std::vector<int>& depth) : fronts_(fronts), depth_(depth) {}

  void place(const std::vector<int>& list, const std::vector<int>& lane_of, std::vector<std::size_t>& start) {
    for (int f : list) {
      const std::size_t size = size_of(f);
      std::size_t& own = used_[depth_[f] % 2];
      start[f] = own;
      own += size;
      most_[depth_[f] % 2] = std::max(most_[depth_[f] % 2], own);
      for (int child : fronts_[f].children)
        if (lane_of[child] == lane_of[f]) used_[depth_[child] % 2] -= size_of(child);
    }
    // The second stack stands behind the first.
    for (int f : list)
      if (depth_[f] % 2 == 1) start[f] += most_[0];
  }
  std::size_t size() const { return most_[0] + most_[1]; }

 private:
  std::size_t size_of(int f) const {
    const auto u = static_cast<std::size_t>(fronts_[f].update_rows);
    return u * u;
  }
  const std::vector<Front>& fronts_;
  const std::vector<int>& depth_;
  std::size_t used_[2] = {0, 0}, most_[2] = {0, 0};
};

}  // namespace

FrontSchedule schedule_fronts(const std::vector<Front>& fronts) {
  const std::vector<double> work = subtree_work(fronts);
  FrontSchedule schedule;
  schedule.lane_of.assign(fronts.size(), kLanes);
  deal(divide(fronts, work), work, schedule.lane_of);
  std::vector<int> depth(fronts.size(), 0);
  for (std::size_t f = fronts.size(); f-- > 0;) {
    const int parent = fronts[f].parent;
    if (parent < 0) continue;
    depth[f] = depth[parent] + 1;
    if (schedule.lane_of[parent] < kLanes) schedule.lane_of[f] = schedule.lane_of[parent];
  }
  schedule.lanes.resize(kLanes);
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    const int lane = schedule.lane_of[f];
    (lane < kLanes ? schedule.lanes[lane] : schedule.top).push_back(static_cast<int>(f));
  }
  schedule.update_start.assign(fronts.size(), 0);
  for (int lane = 0; lane <= kLanes; ++lane) {
    Arena arena(fronts, depth);
    arena.place(lane < kLanes ? schedule.lanes[lane] : schedule.top, schedule.lane_of, schedule.update_start);
    schedule.arena_size.push_back(arena.size());
  }
  return schedule;
}

}  // namespace skinframe
