// SPDX-License-Identifier: GPL-3.0-or-later
// Where the solid is stressed (Wang et al. 2013, section 4.2): the body filled with tetrahedra, clamped at
// its base contact, under self weight and the job's loads; the largest von Mises stress of all load cases.
// The node density of the sampling follows it.
//
// The solid is that enclosed by M1, which the frame stands for. Where M1 has parts that no solid joins to the
// base, M itself is taken instead, necks included; what then still hangs free has no stress.
// The largest part is held at its lowest vertices where the lattice finds nothing between it and the contact.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"
#include "worker/stress/elasticity.h"

namespace skinframe {

// One force on a round patch of the surface about a point. Loads of one name act together.
struct StressLoad {
  std::string name;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
  double radius_mm = 5.0;
};

struct StressOptions {
  ElasticMaterial material;
  double density_g_cm3 = 1.0;         // > 0
  double contact_tolerance_mm = 1.0;  // supports: what stands this near to the lowest plane, > 0
  int tetrahedra = 30000;             // aimed at, in [1000, 100000]; those cut by the surface come on top
  Status validate() const;
};

class StressMap {
 public:
  // Of the solid nearest to the point, smoothed over about a lattice spacing; none further than two spacings
  // from all tetrahedra. >= 0.
  std::optional<double> von_mises_mpa_at(const Eigen::Vector3d& point_mm) const;

  double largest_mpa() const;  // at a vertex
  double spacing_mm() const;
  int tetrahedra() const;
  // Volume with a known stress, of that enclosed by M1 (or by M, see uses_whole_body()).
  double covered_volume_share() const;
  bool uses_whole_body() const;  // M instead of M1

 private:
  friend Result<StressMap> map_stress(const Skin&, const std::vector<StressLoad>&, const StressOptions&,
                                      RunContext&);
  struct State;
  std::shared_ptr<const State> state_;
};

// Errors: kInvalidInput when there is no solid to speak of (M1 empty or thinner than the lattice) or nothing
// of it stands on the contact; kCancelled. Reports Stage::kStress.
Result<StressMap> map_stress(const Skin& skin, const std::vector<StressLoad>& loads,
                             const StressOptions& options, RunContext& context);

}  // namespace skinframe
