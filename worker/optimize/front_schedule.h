// SPDX-License-Identifier: GPL-3.0-or-later
// Who factorises which front, and where the update matrices wait for their parents.
//
// Subtrees of the assembly tree that need nothing of one another are dealt to kLanes lanes of about equal
// work; what stands above them, the top, follows when all lanes are done. Each lane and the top has an arena
// of its own for update matrices: two stacks that grow towards each other, fronts of even depth on one and of
// odd depth on the other, so that a front's update is written while its children's are still there.
// The schedule depends on the matrix alone: the number of threads changes neither it nor any sum.
#pragma once

#include <cstddef>
#include <vector>

#include "worker/optimize/block_ordering.h"

namespace skinframe {

inline constexpr int kLanes = 4;

struct FrontSchedule {
  std::vector<std::vector<int>> lanes;    // kLanes of them, each a list of fronts, children before parents
  std::vector<int> top;                   // the same
  std::vector<int> lane_of;               // of each front; kLanes: the top
  std::vector<std::size_t> update_start;  // of each front's update matrix in its arena
  std::vector<std::size_t> arena_size;    // kLanes, then the top
};

FrontSchedule schedule_fronts(const std::vector<Front>& fronts);

}  // namespace skinframe
