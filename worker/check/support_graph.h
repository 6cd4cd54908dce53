// SPDX-License-Identifier: GPL-3.0-or-later
// Frame and supports as one graph: pieces of struts between the nodes that divide them, and supports; and
// what holds a node while it is printed. With code of its own, from exported files alone.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/check/claims.h"

namespace skinframe::check {

double degrees_from_vertical(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

class SupportGraph {
 public:
  // Whether it may be so, as far as two programs agree about a distance, or cannot be otherwise.
  enum class Ask { kPossibly, kSurely };

  // `result` has supports; both must outlive the graph.
  SupportGraph(const ExportedPrinter& result, const Surface& outer);

  const ExportedPrinter& result() const { return result_; }
  const ExportedSupports& supports() const { return supports_; }
  const Surface& outer() const { return outer_; }
  // The frame's own nodes first, so many; then those of supports.
  std::size_t own() const { return own_; }
  const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; }
  // For each strut of the frame its nodes from a to b, those that divide it between.
  const std::vector<std::vector<int>>& pieces() const { return pieces_of_; }

  // Not longer than the printable length of its angle.
  bool prints(int a, int b) const;

  // Stands on the base plane, or near enough for the first layers.
  bool on_plate(int node) const;
  // A foot on the skin stands in it.
  bool is_foot(int node) const;
  // Within M, in or at a wall no flatter than the self-supporting angle.
  bool in_steep_wall(int node, Ask ask) const;
  // The material below does not end for four skins.
  bool solid_below(int node, Ask ask) const;
  // Either of the two.
  bool held_by_skin(int node, Ask ask) const;
  // The end of a support below an overhang of the skin.
  bool holds_skin(int node) const;
  // A node along a support, and nothing that is to be held for its own sake.
  bool is_joint(int node) const;

 private:
  const ExportedPrinter& result_;
  const ExportedSupports& supports_;
  const Surface& outer_;
  std::size_t own_;
  std::vector<Eigen::Vector3d> nodes_;
  std::vector<std::vector<int>> pieces_of_;
};

}  // namespace skinframe::check
