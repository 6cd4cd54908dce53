// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/internal_nodes.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "worker/frame/point_tree.h"

namespace skinframe {
namespace {

constexpr double kSamplesAimed = 60000.0;
constexpr double kStepsAcross =
    160.0;  // of the largest edge of M1's box: at most 4 million looks at the field
constexpr int kRounds = 30;
constexpr double kStillInSpacings = 0.05;

std::vector<int> assign(const std::vector<Eigen::Vector3d>& samples,
                        const std::vector<Eigen::Vector3d>& centres, int threads) {
  const PointTree tree(centres);
  std::vector<int> owner(samples.size());
  tbb::task_arena arena(std::max(1, threads));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 1024), [&](const auto& range) {
      int near = 0;  // the sample before has it near
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        near = owner[i] = tree.nearest_by_guess(samples[i], near);
    });
  });
  return owner;
}

}  // namespace

InnerRoom find_inner_room(const Skin& skin, double margin_mm) {
  InnerRoom room;
  room.margin_mm = margin_mm;
  const BoundingBox box = bounding_box(skin.inner_surface);
  const double aimed = std::cbrt(std::max(skin.cavity_volume_mm3, 0.0) / kSamplesAimed);
  room.spacing_mm = std::max({aimed, box.extent().maxCoeff() / kStepsAcross, 1e-3});
  const Eigen::Vector3i steps = (box.extent() / room.spacing_mm).array().floor().cast<int>();
  const Eigen::Vector3d corner = box.min + 0.5 * (box.extent() - room.spacing_mm * steps.cast<double>());
  const double deepest = -(skin.thickness_mm + margin_mm);
  std::vector<std::vector<Eigen::Vector3d>> layers(steps.z() + 1);
  tbb::parallel_for(0, steps.z() + 1, [&](int z) {
    for (int y = 0; y <= steps.y(); ++y) {
      for (int x = 0; x <= steps.x(); ++x) {
        const Eigen::Vector3d p = corner + room.spacing_mm * Eigen::Vector3d(x, y, z);
        if (skin.field.at(p) <= deepest) layers[z].push_back(p);
      }
    }
  });
  for (const auto& layer : layers) room.samples.insert(room.samples.end(), layer.begin(), layer.end());
  return room;
}

std::vector<Eigen::Vector3d> spread_nodes(const InnerRoom& room, int count, const Skin& skin,
                                          const RunContext& context) {
  std::vector<Eigen::Vector3d> centres = room.samples;
  std::mt19937_64 random(context.seed);
  // The first `count` of a shuffle; std::shuffle's order is not laid down by the standard.
  count = std::min<int>(count, static_cast<int>(centres.size()));
  for (int i = 0; i < count; ++i) std::swap(centres[i], centres[i + random() % (centres.size() - i)]);
  centres.resize(std::max(count, 0));
  if (centres.empty()) return centres;

  for (int round = 0; round < kRounds && !context.cancelled(); ++round) {
    const auto owner = assign(room.samples, centres, context.threads);
    std::vector<Eigen::Vector3d> sum(centres.size(), Eigen::Vector3d::Zero());
    std::vector<int> members(centres.size(), 0);
    for (std::size_t i = 0; i < owner.size(); ++i) {
      sum[owner[i]] += room.samples[i];
      ++members[owner[i]];
    }
    double moved = 0.0;
    for (std::size_t k = 0; k < centres.size(); ++k) {
      if (members[k] == 0) continue;
      const Eigen::Vector3d centre = sum[k] / members[k];
      moved = std::max(moved, (centre - centres[k]).norm());
      centres[k] = centre;
    }
    if (moved < kStillInSpacings * room.spacing_mm) break;
  }
  const PointTree samples(room.samples);
  for (auto& centre : centres) {
    if (skin.field.at(centre) > -(skin.thickness_mm + room.margin_mm - 0.5 * room.spacing_mm)) {
      centre = samples.point(samples.nearest(centre));
    }
  }
  return centres;
}

}  // namespace skinframe
