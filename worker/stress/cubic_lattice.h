// SPDX-License-Identifier: GPL-3.0-or-later
// Points and tetrahedra of the uniform body-centred cubic lattice about a box, two cells of margin on every
// axis. Corners of the cubes first, their centres after.
#pragma once

#include <Eigen/Core>
#include <array>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

class Lattice {
 public:
  Lattice(const BoundingBox& box, double spacing) : spacing_(spacing) {
    cells_ = (box.extent() / spacing).array().ceil().cast<int>() + 2;
    origin_ = 0.5 * (box.min + box.max) - 0.5 * spacing * cells_.cast<double>();
    corners_ = cells_.array() + 1;
    centre_base_ = corners_.x() * corners_.y() * corners_.z();
  }
  int corner(int x, int y, int z) const { return x + corners_.x() * (y + corners_.y() * z); }
  int centre(int x, int y, int z) const { return centre_base_ + x + cells_.x() * (y + cells_.y() * z); }
  bool is_centre(int i) const { return i >= centre_base_; }
  int size() const { return centre_base_ + cells_.x() * cells_.y() * cells_.z(); }
  // In half spacings, whole numbers.
  Eigen::Vector3i halves(int i) const {
    const Eigen::Vector3i n = is_centre(i) ? cells_ : corners_;
    const int shift = is_centre(i) ? 1 : 0;
    if (is_centre(i)) i -= centre_base_;
    return 2 * Eigen::Vector3i(i % n.x(), (i / n.x()) % n.y(), i / (n.x() * n.y())) +
           Eigen::Vector3i::Constant(shift);
  }
  Eigen::Vector3d point(int i) const { return origin_ + 0.5 * spacing_ * halves(i).cast<double>(); }
  const Eigen::Vector3d& origin() const { return origin_; }
  double spacing_mm() const { return spacing_; }
  // Cuts of the edge a b nearer to `point`, one of its ends, pull that onto the surface; table 1 of the
  // paper.
  double pull_mm(int /*point*/, int a, int b) const {
    const double share = is_centre(a) == is_centre(b) ? 0.24999 : 0.41189;
    return share * (point(a) - point(b)).norm();
  }
  // visit(tet): two centres on either side of a face, and an edge of that face; positive volume.
  template <class Visit>
  void for_each_tet(Visit visit) const {
    for (int z = 0; z < cells_.z(); ++z)
      for (int y = 0; y < cells_.y(); ++y)
        for (int x = 0; x < cells_.x(); ++x)
          for (int axis = 0; axis < 3; ++axis) {
            const Eigen::Vector3i p(x, y, z), next = p + Eigen::Vector3i::Unit(axis);
            if (next[axis] == cells_[axis]) continue;
            const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3),
                                  v = Eigen::Vector3i::Unit((axis + 2) % 3);
            const Eigen::Vector3i ring[4] = {next, next + u, next + u + v, next + v};
            for (int k = 0; k < 4; ++k) {
              const Eigen::Vector3i &a = ring[k], &b = ring[(k + 1) % 4];
              visit(std::array<int, 4>{centre(x, y, z), corner(a.x(), a.y(), a.z()),
                                       corner(b.x(), b.y(), b.z()), centre(next.x(), next.y(), next.z())});
            }
          }
  }

 private:
  double spacing_;
  Eigen::Vector3d origin_;
  Eigen::Vector3i cells_, corners_;
  int centre_base_ = 0;
};

}  // namespace skinframe
