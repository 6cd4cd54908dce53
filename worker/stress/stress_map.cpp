// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/stress_map.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <numeric>

#include "worker/stress/lattice.h"

namespace skinframe {
namespace {

constexpr double kGravityMmPerS2 = 9810.0;
constexpr double kLeastSpacingInVoxels = 1.5;  // of the distance field
constexpr double kMostFree = 0.01;             // of M1's volume that may hang free before M is taken
constexpr double kSpanMm2 = 0.05;              // twice the area that three supports must span
constexpr double kLowestInSpacings = 0.1;      // what is so little above the lowest vertex is held with it
constexpr double kSmoothing = 0.25;            // in spacings: nearer vertices do not outvote each other
constexpr double kReach = 1.5;                 // in spacings: vertices that are averaged
constexpr double kFarReach = 2.0;              // in spacings: the nearest one alone

// A body to fill: all that is deeper than depth_mm below M.
struct Body {
  double depth_mm;
  BoundingBox box;
  double volume_mm3;
};

// The tetrahedra that the contact holds, and the held vertices.
struct HeldMesh {
  TetMesh mesh;
  std::vector<char> held;
  double free_volume_mm3 = 0.0;
};

Result<TetMesh> fill(const Skin& skin, const Body& body, double spacing, const RunContext& context) {
  return fill_with_tetrahedra([&](const Eigen::Vector3d& p) { return skin.field.at(p) + body.depth_mm; },
                              body.box, spacing, context);
}

bool spans_a_plane(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 3) return false;
  const auto far_from = [&](const Eigen::Vector3d& p) {
    return *std::max_element(points.begin(), points.end(), [&](const auto& x, const auto& y) {
      return (x - p).squaredNorm() < (y - p).squaredNorm();
    });
  };
  const Eigen::Vector3d a = far_from(points[0]), b = far_from(a);
  return std::any_of(points.begin(), points.end(),
                     [&](const auto& c) { return (b - a).cross(c - a).norm() >= kSpanMm2; });
}

// Of some vertices, those at or below the height, and the lowest ones beyond until three are not in line.
void hold_lowest(const TetMesh& mesh, std::vector<int> vertices, double height, std::vector<char>& held) {
  const auto z = [&](int v) { return mesh.vertices_mm[v].z(); };
  std::stable_sort(vertices.begin(), vertices.end(), [&](int i, int j) { return z(i) < z(j); });
  std::vector<Eigen::Vector3d> points;
  bool enough = false;
  for (const int v : vertices) {
    if (z(v) > height && enough) break;
    held[v] = 1;
    points.push_back(mesh.vertices_mm[v]);
    enough = enough || spans_a_plane(points);
  }
}

// The components that stand on the contact, and the largest in any case: where the lattice is too coarse for
// what joins it to the contact, it is held where it is lowest. The others go: a linear system with a free one
// has no solution.
HeldMesh keep_held(TetMesh mesh, double contact_height, double spacing) {
  const auto component = face_components(mesh);
  std::map<int, std::vector<int>> vertices_of;
  std::map<int, double> volume_of;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    auto& list = vertices_of[component[t]];
    list.insert(list.end(), mesh.tets[t].begin(), mesh.tets[t].end());
    volume_of[component[t]] += tet_volume_mm3(mesh, mesh.tets[t]);
  }
  int largest = 0;
  for (const auto& [c, volume] : volume_of)
    if (volume > volume_of.at(largest)) largest = c;
  HeldMesh out;
  out.held.assign(mesh.vertices_mm.size(), 0);
  std::map<int, bool> stands;
  for (auto& [c, vertices] : vertices_of) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Eigen::Vector3d> low;
    double lowest = std::numeric_limits<double>::infinity();
    for (const int v : vertices) {
      lowest = std::min(lowest, mesh.vertices_mm[v].z());
      if (mesh.vertices_mm[v].z() <= contact_height) low.push_back(mesh.vertices_mm[v]);
    }
    stands[c] = c == largest || spans_a_plane(low);
    const double height = std::max(contact_height, lowest + kLowestInSpacings * spacing);
    if (stands[c]) hold_lowest(mesh, vertices, height, out.held);
  }
  std::vector<std::array<int, 4>> kept;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (stands[component[t]])
      kept.push_back(mesh.tets[t]);
    else
      out.free_volume_mm3 += tet_volume_mm3(mesh, mesh.tets[t]);
  }
  mesh.tets = std::move(kept);
  out.mesh = std::move(mesh);
  return out;
}

NodalVectors self_weight_n(const TetMesh& mesh, double density_g_cm3) {
  NodalVectors forces(mesh.vertices_mm.size(), Eigen::Vector3d::Zero());
  const double weight = density_g_cm3 * 1e-9 * kGravityMmPerS2;  // N/mm3
  for (const auto& tet : mesh.tets)
    for (const int v : tet) forces[v].z() -= 0.25 * weight * tet_volume_mm3(mesh, tet);
  return forces;
}

// Over the surface within the radius of the surface's nearest vertex, by area; on that vertex where no
// triangle's middle is so near.
void press(const StressLoad& load, const TetMesh& mesh, const std::vector<std::array<int, 3>>& surface,
           NodalVectors& forces) {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : surface)
    for (const int v : t) {
      const double d = (mesh.vertices_mm[v] - load.point_mm).squaredNorm();
      if (d < least || (d == least && v < nearest)) {
        least = d;
        nearest = v;
      }
    }
  std::vector<std::pair<const std::array<int, 3>*, double>> patch;
  double area = 0.0;
  for (const auto& t : surface) {
    const Eigen::Vector3d &a = mesh.vertices_mm[t[0]], &b = mesh.vertices_mm[t[1]],
                          &c = mesh.vertices_mm[t[2]];
    if (((a + b + c) / 3.0 - mesh.vertices_mm[nearest]).norm() > load.radius_mm) continue;
    patch.emplace_back(&t, 0.5 * (b - a).cross(c - a).norm());
    area += patch.back().second;
  }
  if (!(area > 0.0)) forces[nearest] += load.force_n;
  for (const auto& [t, share] : patch)
    for (const int v : *t) forces[v] += load.force_n * (share / (3.0 * area));
}

std::vector<NodalVectors> load_cases(const TetMesh& mesh, const std::vector<StressLoad>& loads,
                                     double density_g_cm3) {
  std::vector<NodalVectors> cases{self_weight_n(mesh, density_g_cm3)};
  const auto surface = boundary_of(mesh);
  std::map<std::string, std::size_t> case_of;
  for (const StressLoad& load : loads) {
    const auto [it, fresh] = case_of.try_emplace(load.name, cases.size());
    if (fresh) cases.push_back(cases.front());
    press(load, mesh, surface, cases[it->second]);
  }
  return cases;
}

// At the vertices: the mean of the tetrahedra about, by volume, of the worst load case there.
std::vector<double> nodal_von_mises(const TetMesh& mesh, const std::vector<ElasticResponse>& responses) {
  std::vector<double> worst(mesh.vertices_mm.size(), 0.0), volume(worst.size(), 0.0);
  for (const auto& tet : mesh.tets)
    for (const int v : tet) volume[v] += tet_volume_mm3(mesh, tet);
  for (const ElasticResponse& response : responses) {
    std::vector<double> sum(worst.size(), 0.0);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const double share = tet_volume_mm3(mesh, mesh.tets[t]) * von_mises_mpa(response.stress_mpa[t]);
      for (const int v : mesh.tets[t]) sum[v] += share;
    }
    for (std::size_t v = 0; v < worst.size(); ++v)
      if (volume[v] > 0.0) worst[v] = std::max(worst[v], sum[v] / volume[v]);
  }
  return worst;
}

}  // namespace

struct StressMap::State {
  using Cell = std::array<int, 3>;
  double spacing_mm = 0.0;
  int tetrahedra = 0;
  double covered_share = 0.0;
  bool whole_body = false;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> von_mises_mpa;
  std::map<Cell, std::vector<int>> cells;  // of the spacing's width

  Cell cell_of(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d i = (p / spacing_mm).array().floor();
    return {static_cast<int>(i.x()), static_cast<int>(i.y()), static_cast<int>(i.z())};
  }
  template <class Visit>
  void near(const Eigen::Vector3d& p, Visit visit) const {
    const Cell middle = cell_of(p);
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        for (int z = -2; z <= 2; ++z) {
          const auto it = cells.find({middle[0] + x, middle[1] + y, middle[2] + z});
          if (it == cells.end()) continue;
          for (const int i : it->second) visit(i, (points[i] - p).norm());
        }
  }
};

std::optional<double> StressMap::von_mises_mpa_at(const Eigen::Vector3d& p) const {
  constexpr double kFarMm = 1e6;
  if (!state_ || !(p.cwiseAbs().maxCoeff() < kFarMm)) return std::nullopt;
  const State& s = *state_;
  double sum = 0.0, weight = 0.0, least = kFarReach * s.spacing_mm;
  std::optional<double> nearest;
  s.near(p, [&](int i, double distance) {
    if (distance < least) {
      least = distance;
      nearest = s.von_mises_mpa[i];
    }
    if (distance > kReach * s.spacing_mm) return;
    const double d = std::hypot(distance, kSmoothing * s.spacing_mm);
    const double w = 1.0 / (d * d * d * d);
    sum += w * s.von_mises_mpa[i];
    weight += w;
  });
  return weight > 0.0 ? std::optional(sum / weight) : nearest;
}

double StressMap::largest_mpa() const {
  return state_ ? *std::max_element(state_->von_mises_mpa.begin(), state_->von_mises_mpa.end()) : 0.0;
}
double StressMap::spacing_mm() const { return state_ ? state_->spacing_mm : 0.0; }
int StressMap::tetrahedra() const { return state_ ? state_->tetrahedra : 0; }
double StressMap::covered_volume_share() const { return state_ ? state_->covered_share : 0.0; }
bool StressMap::uses_whole_body() const { return state_ && state_->whole_body; }

Status StressOptions::validate() const {
  if (!(material.modulus_mpa > 0.0) || !(material.poisson_ratio >= 0.0 && material.poisson_ratio <= 0.49))
    return invalid_input("the stress map needs a modulus above 0 and a Poisson ratio in [0, 0.49]");
  if (!(density_g_cm3 > 0.0)) return invalid_input("the stress map needs a density above 0");
  if (!(contact_tolerance_mm > 0.0)) return invalid_input("the contact tolerance must be above 0");
  if (tetrahedra < 1000 || tetrahedra > 100000)
    return invalid_input(fmt::format("{} tetrahedra: must lie between 1000 and 100000", tetrahedra));
  return ok_status();
}

Result<StressMap> map_stress(const Skin& skin, const std::vector<StressLoad>& loads,
                             const StressOptions& options, RunContext& context) {
  if (auto status = options.validate(); !status) return status.error();
  context.report({.stage = Stage::kStress});
  if (skin.inner_surface.triangles.empty() || !(skin.cavity_volume_mm3 > 0.0))
    return invalid_input("the body is thinner than two skins everywhere: no solid is enclosed by M1");
  try {
    auto state = std::make_shared<StressMap::State>();
    HeldMesh held;
    Body body{skin.thickness_mm, bounding_box(skin.inner_surface), skin.cavity_volume_mm3};
    for (const bool whole : {false, true}) {
      if (whole) body = {0.0, skin.body_box_mm, skin.cavity_volume_mm3 + skin.volume_mm3};
      state->whole_body = whole;
      state->spacing_mm = std::max({std::cbrt(kTetsACell * body.volume_mm3 / options.tetrahedra),
                                    least_spacing_mm(body.box), kLeastSpacingInVoxels * skin.voxel_mm});
      auto mesh = fill(skin, body, state->spacing_mm, context);
      if (!mesh) return mesh.error();
      const double lowest = skin.plate_z_mm + body.depth_mm;
      held = keep_held(std::move(mesh).value(), lowest + options.contact_tolerance_mm, state->spacing_mm);
      if (!held.mesh.tets.empty() && held.free_volume_mm3 <= kMostFree * body.volume_mm3) break;
    }
    if (held.mesh.tets.empty())
      return invalid_input(
          fmt::format("no part of the solid that is thicker than about {:.2g} mm stands on the contact",
                      state->spacing_mm));
    Prescribed prescribed(held.mesh.vertices_mm.size());
    for (std::size_t v = 0; v < prescribed.size(); ++v)
      if (held.held[v]) prescribed[v] = Eigen::Vector3d::Zero();
    const auto responses = solve_elasticity(held.mesh, options.material, prescribed,
                                            load_cases(held.mesh, loads, options.density_g_cm3), context);
    if (!responses) return responses.error();

    const auto stress = nodal_von_mises(held.mesh, *responses);
    std::vector<char> used(stress.size(), 0);
    for (const auto& tet : held.mesh.tets)
      for (const int v : tet) used[v] = 1;
    for (std::size_t v = 0; v < stress.size(); ++v) {
      if (!used[v]) continue;
      state->cells[state->cell_of(held.mesh.vertices_mm[v])].push_back(
          static_cast<int>(state->points.size()));
      state->points.push_back(held.mesh.vertices_mm[v]);
      state->von_mises_mpa.push_back(stress[v]);
    }
    state->tetrahedra = static_cast<int>(held.mesh.tets.size());
    state->covered_share = volume_mm3(held.mesh) / body.volume_mm3;
    StressMap map;
    map.state_ = std::move(state);
    return map;
  } catch (const std::bad_alloc&) {
    throw;  // the job ends OUT_OF_MEMORY, not INTERNAL
  } catch (const std::exception& e) {
    return internal_error(fmt::format("the stress map could not be computed: {}", e.what()));
  }
}

}  // namespace skinframe
