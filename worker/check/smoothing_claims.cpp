// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

constexpr int kInside = 20000, kTries = 2000000;

bool in_a_strut(const ExportedFrame& frame, const Eigen::Vector3d& p, double slack) {
  return std::any_of(frame.struts.begin(), frame.struts.end(), [&](const ExportedStrut& s) {
    const Eigen::Vector3d &a = frame.nodes_mm[s.a], along = frame.nodes_mm[s.b] - a;
    const double t = std::clamp((p - a).dot(along) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
    return (a + t * along - p).norm() < s.radius_mm + slack;
  });
}

// Of points spread evenly over M, by what they are.
struct Counts {
  int inside = 0;
  int thick = 0;   // nearer to the surface than the skin is thick
  int added = 0;   // deeper, and material that is no strut's
  int either = 0;  // deeper, and material about a strut
};

Counts count_points(const ExportedPrinter& result, const BoundingBox& box, const Surface& outer,
                    const Surface& hollow) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Counts counts;
  for (int i = 0; i < kTries && counts.inside < kInside; ++i) {
    const Eigen::Vector3d u(unit(random), unit(random), unit(random));
    const Eigen::Vector3d p = box.min + u.cwiseProduct(box.extent());
    const double depth = outer.depth_mm(p);
    if (depth <= 0) continue;
    ++counts.inside;
    if (depth < result.skin_thickness_mm) {
      ++counts.thick;
    } else if (hollow.depth_mm(p) <= 0) {
      ++(in_a_strut(result.frame, p, result.voxel_mm) ? counts.either : counts.added);
    }
  }
  return counts;
}

}  // namespace

void claim_smoothing(const ExportedPrinter& result, const TriangleMesh& outer_mesh,
                     const TriangleMesh& cavity, const Surface& outer, Verdict* verdict) {
  if (!result.added_skin_mm3 || cavity.triangles.empty()) return;
  TriangleMesh outward = cavity;
  for (auto& t : outward.triangles) std::swap(t[1], t[2]);
  const Surface hollow(outward);
  const Counts counts = count_points(result, bounding_box(outer_mesh), outer, hollow);
  const double each = counts.inside == 0 ? 0.0 : signed_volume(outer_mesh) / counts.inside;
  const auto error = [&](int count) { return 4 * std::sqrt(static_cast<double>(count) + 1.0) * each; };
  const int skin = counts.thick + counts.added;
  const double least = skin * each, most = (skin + counts.either) * each;
  const double room = error(skin + counts.either) + 0.02 * least;
  verdict->claims.push_back(
      {"skin volume", result.skin_volume_mm3 >= least - room && result.skin_volume_mm3 <= most + room,
       fmt::format("{:.0f} to {:.0f} mm3 by sampling (+- {:.0f}), reported {:.0f} mm3 with smoothed detail",
                   least, most, room, result.skin_volume_mm3)});
  const double added_least = counts.added * each, added_most = (counts.added + counts.either) * each;
  const double added_room = error(counts.added + counts.either) + 0.02 * least;
  verdict->claims.push_back(
      {"smoothed detail",
       *result.added_skin_mm3 >= added_least - added_room &&
           *result.added_skin_mm3 <= added_most + added_room,
       fmt::format(
           "{:.0f} to {:.0f} mm3 of material (+- {:.0f}) is deeper than the skin and no strut's, reported "
           "{:.0f} mm3",
           added_least, added_most, added_room, *result.added_skin_mm3)});
}

}  // namespace skinframe::check
