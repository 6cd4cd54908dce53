// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/narrow_band.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/Prune.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "worker/skin/nearest_on_triangle.h"

namespace skinframe {
namespace {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;
using NumberLeaf = openvdb::Int32Tree::LeafNodeType;
using MaskLeaf = openvdb::BoolTree::LeafNodeType;

constexpr float kSeedVoxels = 2.0F;  // up to there OpenVDB does not grow bands
constexpr int kNone = -1;            // no triangle
// In voxels: by so much one of the six next to a voxel is nearer, where that is d > 2 away. It is the one
// along the largest share of the way, which is 1/sqrt(3) of it at least: d - sqrt(d^2 - 2 d / sqrt(3) + 1).
constexpr double kLeastStep = 0.35;

// In voxels, of the distance that is kept in each round: a voxel further away waits until those nearer to the
// surface about it are known, one of which knows its triangle.
constexpr double kFirstRound = 1.0, kRound = 0.8;

constexpr std::array<std::array<int, 3>, 6> kSteps = {
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

// Some triangles, each once.
struct Triangles {
  std::array<int, 26> numbers;
  int count = 0;
  void add(int triangle) {
    const auto end = numbers.begin() + count;
    if (triangle != kNone && std::find(numbers.begin(), end, triangle) == end) numbers[count++] = triangle;
  }
};

// Which triangle is nearest, of the voxels of one leaf and of those next to it.
class NearestAbout {
 public:
  void look(const Coord& origin, const openvdb::FloatGrid::ConstAccessor& distances,
            const openvdb::Int32Grid::ConstAccessor& numbers) {
    triangle_.fill(kNone);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) look_at_leaf({x, y, z}, origin, distances, numbers);
  }

  // Of the 26 about the voxel.
  Triangles about(openvdb::Index voxel) const {
    const Coord at = Leaf::offsetToLocalCoord(voxel);
    Triangles found;
    for (int x = 0; x <= 2; ++x)
      for (int y = 0; y <= 2; ++y)
        for (int z = 0; z <= 2; ++z) found.add(triangle_[place(at.x() + x, at.y() + y, at.z() + z)]);
    return found;
  }

 private:
  static constexpr int kWidth = Leaf::DIM + 2;
  static int place(int x, int y, int z) { return (x * kWidth + y) * kWidth + z; }

  void look_at_leaf(const std::array<int, 3>& side, const Coord& origin,
                    const openvdb::FloatGrid::ConstAccessor& distances,
                    const openvdb::Int32Grid::ConstAccessor& numbers) {
    const int width = Leaf::DIM;
    const Coord there = origin.offsetBy(side[0] * width, side[1] * width, side[2] * width);
    const Leaf* leaf = distances.probeConstLeaf(there);
    const NumberLeaf* number = leaf != nullptr ? numbers.probeConstLeaf(there) : nullptr;
    if (number == nullptr) return;
    std::array<int, 3> low{}, high{};
    for (int k = 0; k < 3; ++k) {
      low[k] = side[k] < 0 ? width - 1 : 0;
      high[k] = side[k] > 0 ? 0 : width - 1;
    }
    for (int x = low[0]; x <= high[0]; ++x)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int z = low[2]; z <= high[2]; ++z) {
          const openvdb::Index voxel = Leaf::coordToOffset(Coord(x, y, z));
          if (leaf->isValueOn(voxel))
            triangle_[place(x + side[0] * width + 1, y + side[1] * width + 1, z + side[2] * width + 1)] =
                number->getValue(voxel);
        }
  }

  std::array<int, kWidth * kWidth * kWidth> triangle_;
};

class Widening {
 public:
  Widening(openvdb::FloatGrid& distances, openvdb::Int32Grid& numbers,
           const std::vector<openvdb::Vec3s>& points, const std::vector<openvdb::Vec3I>& triangles,
           double outer_voxels, double inner_voxels)
      : distances_(distances),
        numbers_(numbers),
        points_(points),
        triangles_(triangles),
        voxel_mm_(distances.voxelSize().x()),
        outer_mm_(outer_voxels * voxel_mm_),
        inner_mm_(inner_voxels * voxel_mm_) {}

  void run() {
    auto next = about_seeds();
    for (double limit = kFirstRound; next->leafCount() > 0; limit += kRound)
      next = grow(*next, limit * voxel_mm_);
  }

 private:
  using MaskPtr = openvdb::BoolTree::Ptr;
  struct Measured {
    openvdb::Index voxel;
    float distance_mm;  // signed
    int triangle;
  };
  struct Growth {  // of one leaf
    Coord origin;
    std::vector<Measured> kept;
    std::vector<openvdb::Index> later;
  };

  double band_mm(bool inside) const { return inside ? inner_mm_ : outer_mm_; }

  // The mask of the voxels that mark(item, here) sets, gathered over the items.
  template <class Mark>
  static MaskPtr gather(std::size_t items, const Mark& mark) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, items, 64), std::make_shared<openvdb::BoolTree>(false),
        [&](const auto& range, const MaskPtr& sum) {
          auto mask = sum->leafCount() == 0 ? std::make_shared<openvdb::BoolTree>(false) : sum;
          openvdb::tree::ValueAccessor<openvdb::BoolTree> here(*mask);
          for (std::size_t i = range.begin(); i < range.end(); ++i) mark(i, here);
          return mask;
        },
        [](const MaskPtr& mask, const MaskPtr& other) {
          mask->merge(*other);
          return mask;
        });
  }

  // The voxels next to a measured one that are not measured and may be within the band.
  template <class Mask>
  void mark_about(const Coord& at, float distance_mm, const openvdb::FloatGrid::ConstAccessor& distances,
                  Mask& mask) const {
    if (std::abs(distance_mm) + kLeastStep * voxel_mm_ >= band_mm(distance_mm < 0.0F)) return;
    for (const auto& [x, y, z] : kSteps) {
      const Coord to = at.offsetBy(x, y, z);
      if (!distances.isValueOn(to)) mask.setValueOn(to);
    }
  }

  MaskPtr about_seeds() const {
    std::vector<const Leaf*> leaves;
    distances_.tree().getNodes(leaves);
    return gather(leaves.size(), [&](std::size_t i, auto& mask) {
      const auto distances = distances_.getConstAccessor();
      for (auto it = leaves[i]->cbeginValueOn(); it; ++it) mark_about(it.getCoord(), *it, distances, mask);
    });
  }

  // Measures the voxels named and keeps those up to the limit; returns the others, and those next to the ones
  // that are kept.
  MaskPtr grow(const openvdb::BoolTree& mask, double limit_mm) {
    std::vector<const MaskLeaf*> leaves;
    mask.getNodes(leaves);
    std::vector<Growth> growth(leaves.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size(), 16), [&](const auto& range) {
      const auto distances = distances_.getConstAccessor();
      const auto numbers = numbers_.getConstAccessor();
      NearestAbout nearest;
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        growth[i].origin = leaves[i]->origin();
        nearest.look(leaves[i]->origin(), distances, numbers);
        for (auto it = leaves[i]->cbeginValueOn(); it; ++it) {
          const bool inside = distances.getValue(it.getCoord()) < 0.0F;
          const auto [distance_mm, triangle] = measure(it.getCoord(), nearest.about(it.pos()));
          if (distance_mm > limit_mm && limit_mm < band_mm(inside))
            growth[i].later.push_back(it.pos());
          else if (distance_mm < band_mm(inside))
            growth[i].kept.push_back(
                {it.pos(), static_cast<float>(inside ? -distance_mm : distance_mm), triangle});
        }
      }
    });
    std::vector<std::pair<Leaf*, NumberLeaf*>> grown(growth.size());
    for (std::size_t i = 0; i < growth.size(); ++i)
      if (!growth[i].kept.empty())
        grown[i] = {distances_.tree().touchLeaf(growth[i].origin),
                    numbers_.tree().touchLeaf(growth[i].origin)};
    tbb::parallel_for(std::size_t{0}, growth.size(), [&](std::size_t i) {
      for (const Measured& m : growth[i].kept) {
        grown[i].first->setValueOn(m.voxel, m.distance_mm);
        grown[i].second->setValueOn(m.voxel, m.triangle);
      }
    });
    return gather(growth.size(), [&](std::size_t i, auto& next) {
      const auto distances = distances_.getConstAccessor();
      const Coord& origin = growth[i].origin;
      for (const openvdb::Index voxel : growth[i].later)
        next.setValueOn(origin + Leaf::offsetToLocalCoord(voxel));
      for (const Measured& m : growth[i].kept)
        mark_about(origin + Leaf::offsetToLocalCoord(m.voxel), m.distance_mm, distances, next);
    });
  }

  // The distance to the nearest of the triangles, and which that is.
  std::pair<double, int> measure(const Coord& at, const Triangles& among) const {
    const Eigen::Vector3d p(at.x(), at.y(), at.z());
    double least = std::numeric_limits<double>::infinity();
    int which = kNone;
    for (int i = 0; i < among.count; ++i) {
      const int triangle = among.numbers[i];
      const double squared = (p - nearest_on_triangle(p, corners(triangle))).squaredNorm();
      if (squared > least || (squared == least && triangle > which)) continue;
      least = squared;
      which = triangle;
    }
    return {std::sqrt(least) * voxel_mm_, which};
  }

  Corners corners(int triangle) const {
    const auto corner = [&](int k) {
      const openvdb::Vec3s& p = points_[triangles_[triangle][k]];
      return Eigen::Vector3d(p.x(), p.y(), p.z());
    };
    return {corner(0), corner(1), corner(2)};
  }

  openvdb::FloatGrid& distances_;
  openvdb::Int32Grid& numbers_;                // of the nearest triangle, where the distance is active
  const std::vector<openvdb::Vec3s>& points_;  // in voxels
  const std::vector<openvdb::Vec3I>& triangles_;
  double voxel_mm_, outer_mm_, inner_mm_;
};

}  // namespace

openvdb::FloatGrid::Ptr narrow_band(const std::vector<openvdb::Vec3s>& points_mm,
                                    const std::vector<openvdb::Vec3I>& triangles, double voxel_mm,
                                    double outer_voxels, double inner_voxels) {
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel_mm);
  std::vector<openvdb::Vec3s> points;
  points.reserve(points_mm.size());
  for (const openvdb::Vec3s& p : points_mm) points.emplace_back(transform->worldToIndex(openvdb::Vec3d(p)));
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(points, triangles);
  openvdb::Int32Grid numbers(kNone);
  auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(mesh, *transform, kSeedVoxels, kSeedVoxels, 0,
                                                               &numbers);
  // Rounded as OpenVDB rounds them.
  const float outside = static_cast<float>(outer_voxels) * static_cast<float>(voxel_mm),
              inside = -static_cast<float>(inner_voxels) * static_cast<float>(voxel_mm);
  openvdb::tools::changeAsymmetricLevelSetBackground(grid->tree(), outside, inside);
  Widening(*grid, numbers, points, triangles, outer_voxels, inner_voxels).run();
  openvdb::tools::pruneLevelSet(grid->tree(), outside, inside);
  return grid;
}

}  // namespace skinframe
