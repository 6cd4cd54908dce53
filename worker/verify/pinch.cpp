// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/pinch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace skinframe {
namespace {

using Eigen::Vector3d;

constexpr double kLooksAway = -0.5;  // cosine of the opposite wall's normal
constexpr double kLooksAlike = 0.3;  // cosine, of the nodes of one patch
constexpr double kLeastApartInSkins = 4;
constexpr double kFurthestInRadii = 1;  // of the exit from the nearest node
// Nodes that were left on a chord, or that stand in a fold of it, have no skin to press on.
constexpr double kOffM1InSkins = 0.25;  // at most
constexpr double kLooksOut = 0.8;       // cosine, at least, of a node's normal and the way out
constexpr double kFarMm = 1e5;

double squared(const Vector3d& v) { return v.squaredNorm(); }

std::vector<double> node_areas(const FineSkin& fine) {
  const auto& nodes = fine.frame.nodes_mm;
  std::vector<double> area(nodes.size(), 0.0);
  for (const auto& t : fine.frame.skin_triangles) {
    const double third = (nodes[t[1]] - nodes[t[0]]).cross(nodes[t[2]] - nodes[t[0]]).norm() / 6;
    for (const int v : t) area[v] += third;
  }
  return area;
}

// Shares of a force, nodes within the finger's radius on the same side of the wall.
std::vector<std::pair<int, double>> patch(const FineSkin& fine, const std::vector<double>& area, int centre) {
  const auto& nodes = fine.frame.nodes_mm;
  std::vector<std::pair<int, double>> shares;
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (squared(nodes[i] - nodes[centre]) > kPinchRadiusMm * kPinchRadiusMm) continue;
    if (fine.normals[i].dot(fine.normals[centre]) < kLooksAlike || !(area[i] > 0)) continue;
    shares.emplace_back(static_cast<int>(i), area[i]);
    sum += area[i];
  }
  for (auto& share : shares) share.second /= sum;
  if (shares.empty()) shares = {{centre, 1.0}};
  return shares;
}

std::vector<PinchSite> all_sites(const FineSkin& fine, const Skin& skin, const TriangleTree& body) {
  const auto& nodes = fine.frame.nodes_mm;
  constexpr std::size_t kMostTried = 3000;
  const std::size_t stride = std::max<std::size_t>(1, nodes.size() / kMostTried);
  std::vector<char> is_in_skin;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    is_in_skin.push_back(std::abs(skin.field.at(nodes[i]) + skin.thickness_mm) <=
                             kOffM1InSkins * skin.thickness_mm &&
                         fine.normals[i].dot(skin.field.gradient(nodes[i]).stableNormalized()) >= kLooksOut);
  std::vector<PinchSite> sites;
  for (std::size_t i = 0; i < nodes.size(); i += stride) {
    if (!is_in_skin[i]) continue;
    const Vector3d inward = -fine.normals[i];
    const double out = body.way_out(nodes[i], inward, kFarMm);
    if (out >= kFarMm || out < kLeastApartInSkins * skin.thickness_mm) continue;
    const Vector3d exit = nodes[i] + (out - skin.thickness_mm) * inward;
    int opposite = -1;
    double least = kFurthestInRadii * kFurthestInRadii * kPinchRadiusMm * kPinchRadiusMm;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double d = squared(nodes[k] - exit);
      if (d >= least || !is_in_skin[k] || fine.normals[k].dot(fine.normals[i]) > kLooksAway) continue;
      least = d;
      opposite = static_cast<int>(k);
    }
    if (opposite >= 0) sites.push_back({static_cast<int>(i), opposite, (nodes[opposite] - nodes[i]).norm()});
  }
  return sites;
}

}  // namespace

std::vector<PinchSite> spread_pinches(const FineSkin& fine, const Skin& skin, const TriangleTree& body,
                                      std::size_t count) {
  const std::vector<PinchSite> all = all_sites(fine, skin, body);
  if (all.empty()) return {};
  const auto& nodes = fine.frame.nodes_mm;
  // A pair pressed from its other end is the same pinch.
  const auto apart = [&](const PinchSite& a, const PinchSite& b) {
    const Vector3d &a1 = nodes[a.node], &a2 = nodes[a.opposite], &b1 = nodes[b.node], &b2 = nodes[b.opposite];
    return std::min(squared(a1 - b1) + squared(a2 - b2), squared(a1 - b2) + squared(a2 - b1));
  };
  std::size_t next = std::max_element(all.begin(), all.end(),
                                      [](const auto& a, const auto& b) { return a.apart_mm < b.apart_mm; }) -
                     all.begin();
  std::vector<double> distance(all.size(), std::numeric_limits<double>::infinity());
  std::vector<PinchSite> chosen;
  while (chosen.size() < std::min(count, all.size())) {
    chosen.push_back(all[next]);
    for (std::size_t i = 0; i < all.size(); ++i)
      distance[i] = std::min(distance[i], apart(all[i], chosen.back()));
    next = std::max_element(distance.begin(), distance.end()) - distance.begin();
    if (!(distance[next] > 0)) break;
  }
  return chosen;
}

NodalColumns pinch_columns(const Structure& structure, const FineSkin& fine,
                           const std::vector<PinchSite>& sites) {
  NodalColumns f = NodalColumns::Zero(6 * static_cast<Eigen::Index>(structure.nodes_mm.size()),
                                      static_cast<Eigen::Index>(sites.size()));
  const std::vector<double> area = node_areas(fine);
  for (std::size_t c = 0; c < sites.size(); ++c) {
    const auto near = patch(fine, area, sites[c].node), far = patch(fine, area, sites[c].opposite);
    const auto middle = [&](const auto& shares) {
      Vector3d sum = Vector3d::Zero();
      for (const auto& [node, share] : shares) sum += share * structure.nodes_mm[node];
      return sum;
    };
    const Vector3d push = kPinchForceN * (middle(far) - middle(near)).normalized();
    for (const auto& [node, share] : near) f.col(c).segment<3>(6 * node) += share * push;
    for (const auto& [node, share] : far) f.col(c).segment<3>(6 * node) -= share * push;
  }
  return f;
}

}  // namespace skinframe
