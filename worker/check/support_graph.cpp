// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/support_graph.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skinframe::check {
namespace {

using Eigen::Vector3d;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kLengthTolerance = 1e-6;  // relative
constexpr double kNormalToleranceDegrees = 0.5;
constexpr double kWallReachInSkins = 1.5;  // a node deeper than this is in no wall
constexpr double kTooNearInSkins = 0.05;   // to the surface to tell how steep it is
constexpr double kSolidBelowInSkins = 4.0;

}  // namespace

double degrees_from_vertical(const Vector3d& a, const Vector3d& b) {
  const Vector3d d = b - a;
  return std::atan2(d.head<2>().norm(), std::abs(d.z())) * kDegrees;
}

SupportGraph::SupportGraph(const ExportedPrinter& result, const Surface& outer)
    : result_(result),
      supports_(*result.supports),
      outer_(outer),
      own_(result.frame.nodes_mm.size()),
      nodes_(result.frame.nodes_mm) {
  for (const ExportedSupportNode& node : supports_.nodes) nodes_.push_back(node.at_mm);
  pieces_of_.resize(result.frame.struts.size());
  for (std::size_t j = 0; j < pieces_of_.size(); ++j) pieces_of_[j] = {result.frame.struts[j].a};
  for (std::size_t i = 0; i < supports_.nodes.size(); ++i)
    if (supports_.nodes[i].strut >= 0)
      pieces_of_[supports_.nodes[i].strut].push_back(static_cast<int>(own_ + i));
  for (std::size_t j = 0; j < pieces_of_.size(); ++j) {
    auto& list = pieces_of_[j];
    const Vector3d from = nodes_[result.frame.struts[j].a];
    std::sort(list.begin() + 1, list.end(),
              [&](int p, int q) { return (nodes_[p] - from).norm() < (nodes_[q] - from).norm(); });
    list.push_back(result.frame.struts[j].b);
  }
}

bool SupportGraph::prints(int a, int b) const {
  const double printable =
      printable_mm(supports_.printable_length, degrees_from_vertical(nodes_[a], nodes_[b]));
  return (nodes_[a] - nodes_[b]).norm() <= printable * (1 + kLengthTolerance);
}

bool SupportGraph::on_plate(int node) const {
  if (node >= static_cast<int>(own_) && supports_.nodes[node - own_].on == "plate")
    return std::abs(nodes_[node].z() - supports_.plate_z_mm) <= 1e-6;
  return nodes_[node].z() <= supports_.plate_z_mm + supports_.plate_reach_mm + 1e-9;
}

bool SupportGraph::is_foot(int node) const {
  if (node < static_cast<int>(own_) || supports_.nodes[node - own_].on != "skin") return false;
  const double depth = outer_.depth_mm(nodes_[node]), h = result_.skin_thickness_mm;
  return depth >= -0.6 * h && depth <= 1.1 * h;
}

bool SupportGraph::in_steep_wall(int node, Ask ask) const {
  const Vector3d &p = nodes_[node], q = outer_.nearest(p);
  const double h = result_.skin_thickness_mm, distance = (q - p).norm();
  const double room = ask == Ask::kPossibly ? 1.0 : -1.0;
  if (distance <= kTooNearInSkins * h) return ask == Ask::kPossibly;
  if (outer_.depth_mm(p) < 0.0 || distance > (kWallReachInSkins + 0.01 * room) * h) return false;
  const double flatness = std::asin(std::clamp(std::abs(q.z() - p.z()) / distance, 0.0, 1.0)) * kDegrees;
  return flatness <= supports_.self_supporting_angle_deg + room * kNormalToleranceDegrees;
}

bool SupportGraph::solid_below(int node, Ask ask) const {
  const double h = result_.skin_thickness_mm, room = (ask == Ask::kPossibly ? 0.2 : -0.2) * h;
  for (double s = 0.5 * h; s <= kSolidBelowInSkins * h - room; s += 0.25 * h) {
    const Vector3d p = nodes_[node] - Vector3d(0, 0, s);
    const double depth = outer_.depth_mm(p);
    if (p.z() > supports_.plate_z_mm && (depth > 1.1 * h + room || depth < -0.1 * h - room)) return false;
  }
  return true;
}

bool SupportGraph::held_by_skin(int node, Ask ask) const {
  return in_steep_wall(node, ask) || solid_below(node, ask);
}

bool SupportGraph::holds_skin(int node) const {
  return node >= static_cast<int>(own_) && supports_.nodes[node - own_].on == "roof";
}

bool SupportGraph::is_joint(int node) const {
  return node >= static_cast<int>(own_) && supports_.nodes[node - own_].on == "support";
}

double printable_mm(const std::vector<std::pair<double, double>>& curve, double degrees) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const auto& [angle, length] = curve[i];
    if (degrees > angle + 1e-9) continue;
    if (i == 0 || degrees >= angle - 1e-9) return length;
    const auto& [steeper, longer] = curve[i - 1];
    if (std::isinf(longer)) return length;
    return longer + (length - longer) * (degrees - steeper) / (angle - steeper);
  }
  return curve.back().second;
}

}  // namespace skinframe::check
