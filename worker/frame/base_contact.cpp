// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/base_contact.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace skinframe {
namespace {

constexpr int kMaxPins = 16;
constexpr double kSpanMm2 = 0.05;  // twice the area that three points must span not to be in line

double cross(const Eigen::Vector3d& o, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

double distance_xy(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).head<2>().norm(); }

// Indices of the convex hull's corners in xy (monotone chain).
std::vector<int> hull_corners(const std::vector<Eigen::Vector3d>& points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    if (points[i].x() != points[j].x()) return points[i].x() < points[j].x();
    return points[i].y() != points[j].y() ? points[i].y() < points[j].y() : i < j;
  });
  std::vector<int> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (int i : order) {
      while (hull.size() >= start + 2 &&
             cross(points[hull[hull.size() - 2]], points[hull.back()], points[i]) <= 0) {
        hull.pop_back();
      }
      hull.push_back(i);
    }
    hull.pop_back();
    std::reverse(order.begin(), order.end());
  }
  return hull;
}

template <class Score>
int best_of(const std::vector<int>& candidates, Score score) {
  return *std::max_element(candidates.begin(), candidates.end(),
                           [&](int i, int j) { return score(i) < score(j); });
}

}  // namespace

std::vector<int> choose_pins(const std::vector<Eigen::Vector3d>& points, double spacing_mm) {
  if (points.size() < 3) return {};
  const std::vector<int> corners = hull_corners(points);
  if (corners.size() < 3) return {};
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int i : corners) centre += points[i] / static_cast<double>(corners.size());

  const int p = best_of(corners, [&](int i) { return distance_xy(points[i], centre); });
  const int q = best_of(corners, [&](int i) { return distance_xy(points[i], points[p]); });
  const int r = best_of(corners, [&](int i) { return std::abs(cross(points[p], points[q], points[i])); });
  if (std::abs(cross(points[p], points[q], points[r])) < kSpanMm2) return {};
  std::vector<int> pins{p, q, r};
  const auto room = [&](int i) {
    double nearest = distance_xy(points[i], points[pins[0]]);
    for (int pin : pins) nearest = std::min(nearest, distance_xy(points[i], points[pin]));
    return nearest;
  };
  while (static_cast<int>(pins.size()) < kMaxPins) {
    const int next = best_of(corners, room);
    if (room(next) < spacing_mm) break;
    pins.push_back(next);
  }
  return pins;
}

std::vector<int> contact_nodes(const std::vector<Eigen::Vector3d>& nodes, int skin_nodes, double height_mm) {
  std::vector<int> order(skin_nodes);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return nodes[i].z() < nodes[j].z(); });
  std::vector<int> contact;
  bool spans = false;
  for (int i : order) {
    if (nodes[i].z() > height_mm && spans) break;
    for (std::size_t k = 0; k + 1 < contact.size() && !spans; ++k) {
      spans = std::abs(cross(nodes[contact[k]], nodes[contact[k + 1]], nodes[i])) >= kSpanMm2;
    }
    contact.push_back(i);
  }
  std::sort(contact.begin(), contact.end());
  return contact;
}

}  // namespace skinframe
