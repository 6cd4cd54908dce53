// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/relax_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "worker/frame/on_m1.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

constexpr int kSweeps = 6;
constexpr double kBetterBy = 0.01;
constexpr double kOnM1InVoxels = 0.5;
constexpr double kOffM1Costs = 0.3;  // of the score

class Relaxer {
 public:
  Relaxer(const Skin& skin, int first_node, Frame* frame)
      : skin_(skin), first_node_(first_node), frame_(*frame), fans_(frame->nodes_mm.size()) {
    for (std::size_t t = 0; t < frame_.skin_triangles.size(); ++t)
      for (const int v : frame_.skin_triangles[t]) fans_[v].push_back(static_cast<int>(t));
  }

  // False: nothing moved.
  bool sweep() {
    bool moved = false;
    for (int i = first_node_; i < static_cast<int>(fans_.size()); ++i) {
      if (fans_[i].empty()) continue;
      const Vector3d at = frame_.nodes_mm[i];
      double best = score(i, at);
      if (best >= kGoodScore && is_on_m1(at)) continue;
      Vector3d place = at;
      for (const Vector3d& candidate : candidates(i)) {
        const double s = score(i, candidate);
        if (s <= best + kBetterBy) continue;
        best = s;
        place = candidate;
      }
      frame_.nodes_mm[i] = place;
      moved = moved || place != at;
    }
    return moved;
  }

 private:
  Vector3d corner(int v, int moved, const Vector3d& to) const { return v == moved ? to : frame_.nodes_mm[v]; }

  // Were node i at p.
  double score(int i, const Vector3d& p) const {
    double least = 2;
    std::vector<Vector3d> normals;
    for (const int t : fans_[i]) {
      const auto& tri = frame_.skin_triangles[t];
      const Vector3d a = corner(tri[0], i, p), b = corner(tri[1], i, p), c = corner(tri[2], i, p);
      const Vector3d twice = (b - a).cross(c - a);
      const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
      least = std::min(least, 2 * std::sqrt(3.0) * twice.norm() / std::max(sides, 1e-30));
      normals.push_back(twice.stableNormalized());
    }
    for (std::size_t k = 0; k < fans_[i].size(); ++k)
      for (std::size_t l = k + 1; l < fans_[i].size(); ++l)
        if (share_edge(fans_[i][k], fans_[i][l])) least = std::min(least, 1 + normals[k].dot(normals[l]));
    if (!is_on_m1(p)) least -= kOffM1Costs;
    return least;
  }

  bool is_on_m1(const Vector3d& p) const {
    return std::abs(skin_.field.at(p) + skin_.thickness_mm) <= kOnM1InVoxels * skin_.voxel_mm;
  }

  bool share_edge(int s, int t) const {
    int shared = 0;
    for (const int v : frame_.skin_triangles[s])
      for (const int w : frame_.skin_triangles[t]) shared += v == w;
    return shared == 2;
  }

  std::vector<Vector3d> candidates(int i) const {
    Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
    const Vector3d at = frame_.nodes_mm[i];
    double sides = 0;
    int count = 0;
    for (const int t : fans_[i]) {
      const auto& tri = frame_.skin_triangles[t];
      normal += (frame_.nodes_mm[tri[1]] - frame_.nodes_mm[tri[0]])
                    .cross(frame_.nodes_mm[tri[2]] - frame_.nodes_mm[tri[0]]);
      for (const int v : tri) {
        if (v == i) continue;
        middle += frame_.nodes_mm[v];
        sides += (frame_.nodes_mm[v] - at).norm();
        ++count;
      }
    }
    middle /= count;
    const double reach = sides / count;
    normal.stableNormalize();
    std::vector<Vector3d> out;
    for (const Vector3d& from : {middle, Vector3d((middle + at) / 2), at}) {
      out.push_back(from);
      out.push_back(onto_m1(from, skin_));
      if (const auto ahead = first_on_m1(from, normal, reach, skin_)) out.push_back(*ahead);
    }
    return out;
  }

  const Skin& skin_;
  const int first_node_;
  Frame& frame_;
  std::vector<std::vector<int>> fans_;  // triangles about a node
};

}  // namespace

void relax_skin(const Skin& skin, int first_node, Frame* frame) {
  Relaxer relaxer(skin, first_node, frame);
  for (int sweep = 0; sweep < kSweeps && relaxer.sweep(); ++sweep) {
  }
}

}  // namespace skinframe
