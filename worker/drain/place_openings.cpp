// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/drain/place_openings.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include "worker/drain/cut_sheet.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {

constexpr int kSites = 2500;
constexpr int kDirections = 12;           // looked at about a site
constexpr double kBeyondRim = 1.2;        // in rim radii: as far M has to be flat
constexpr double kHighest = 0.6;          // in radii: M's height over the rim's disc
constexpr double kRoomBelow = 0.5;        // in radii, free below the opening
constexpr double kInContactMargin = 1.0;  // mm, between a hole and the edge of the contact's hull
constexpr double kApartMm = 6.0;          // between the rims of two holes
constexpr double kNextSmaller = 0.85;     // where the diameter has no room
constexpr double kLeastVoidMm3 = 1.0;     // export fills smaller ones
constexpr std::size_t kMostVoids = 32;

struct Site {
  Eigen::Vector3d at, normal;
};

// One in the middle of each of kSites equal shares of the area.
std::vector<Site> spread_sites(const TriangleMesh& mesh) {
  double total = 0.0;
  const auto normal_of = [&](const std::array<int, 3>& t) -> Eigen::Vector3d {
    return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
  };
  for (const auto& t : mesh.triangles) total += normal_of(t).norm();
  std::vector<Site> sites;
  double passed = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d normal = normal_of(t);
    const double area = normal.norm();
    while (static_cast<double>(sites.size()) < kSites &&
           passed + area > total * (static_cast<double>(sites.size()) + 0.5) / kSites) {
      // Within a large triangle by the golden ratio's low-discrepancy sequence (Roberts 2018).
      const double i = static_cast<double>(sites.size()) + 1.0;
      const double x = std::fmod(0.7548776662466927 * i, 1.0), y = std::fmod(0.5698402909980532 * i, 1.0);
      const double root = std::sqrt(x);
      sites.push_back({(1 - root) * mesh.vertices[t[0]] + root * (1 - y) * mesh.vertices[t[1]] +
                           root * y * mesh.vertices[t[2]],
                       normal / area});
    }
    passed += area;
  }
  return sites;
}

struct Candidate {
  Opening opening;
  double cost = 0.0;
  int cavity = -1;
};

class Placing {
 public:
  Placing(const TriangleMesh& mesh, const Skin& skin, const Polygon2& hull, const StressMap* stress,
          const std::vector<TriangleMesh>& cavities, const std::vector<KeepAway>& keep_away,
          const std::vector<Opening>& refused)
      : mesh_(mesh),
        skin_(skin),
        hull_(hull),
        keep_away_(keep_away),
        refused_(refused),
        sites_(spread_sites(mesh)) {
    stress_rank_.assign(sites_.size(), 0.0);
    if (stress != nullptr) rank_stress(*stress);
    for (const TriangleMesh& shell : cavities) {
      const double volume = signed_volume(shell);
      if (volume < kLeastVoidMm3) continue;
      cavities_.push_back({volume, volume_centroid(shell), bounding_box(shell).extent().norm(),
                           std::make_unique<TriangleTree>(shell)});
    }
    std::stable_sort(cavities_.begin(), cavities_.end(),
                     [](const Cavity& a, const Cavity& b) { return a.volume > b.volume; });
  }

  PlacedOpenings place(const OpeningRule& rule, const RunContext& context) {
    PlacedOpenings placed;
    std::vector<int> count(cavities_.size(), 0);
    const std::size_t served = std::min(cavities_.size(), kMostVoids);
    const auto wanted = [&](std::size_t k) { return k == 0 ? std::max(1, rule.least_count) : 1; };
    const auto all_served = [&] {
      for (std::size_t k = 0; k < served; ++k)
        if (count[k] < wanted(k)) return false;
      return true;
    };
    for (double diameter = rule.diameter_mm; diameter > 0.0 && !all_served() && !context.cancelled();) {
      auto candidates = candidates_of(0.5 * diameter);
      for (std::size_t k = 0; k < served; ++k)
        while (count[k] < wanted(k)) {
          const auto best = cheapest(candidates, static_cast<int>(k), placed.openings);
          if (!best) break;
          placed.openings.push_back(*best);
          ++count[k];
        }
      if (diameter <= rule.least_diameter_mm * (1.0 + 1e-9)) break;
      diameter = std::max(rule.least_diameter_mm, kNextSmaller * diameter);
    }
    for (const Opening& opening : placed.openings)
      if (2.0 * opening.radius_mm < rule.diameter_mm)
        placed.warnings.push_back(fmt::format(
            "the drain hole at ({:.1f}, {:.1f}, {:.1f}) mm is {:.3g} mm wide, not {:.3g}: its cavity's skin "
            "has no room for wider ones",
            opening.centre_mm.x(), opening.centre_mm.y(), opening.centre_mm.z(), 2.0 * opening.radius_mm,
            rule.diameter_mm));
    for (std::size_t k = 0; k < cavities_.size(); ++k)
      if (k >= served || count[k] < wanted(k))
        placed.warnings.push_back(words(cavities_[k], count[k], k < served ? wanted(k) : 1, rule));
    return placed;
  }

 private:
  struct Cavity {
    double volume;
    Eigen::Vector3d centre;
    double diagonal;
    std::unique_ptr<TriangleTree> tree;
  };

  void rank_stress(const StressMap& stress) {
    std::vector<std::pair<double, std::size_t>> known;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      const Eigen::Vector3d below = sites_[i].at - skin_.thickness_mm * sites_[i].normal;
      known.emplace_back(stress.von_mises_mpa_at(below).value_or(0.0), i);
    }
    std::sort(known.begin(), known.end());
    for (std::size_t rank = 0; rank < known.size(); ++rank)
      stress_rank_[known[rank].second] = static_cast<double>(rank) / static_cast<double>(known.size());
  }

  std::vector<Candidate> candidates_of(double radius) const {
    std::vector<std::optional<Candidate>> judged(sites_.size());
    tbb::parallel_for(std::size_t{0}, sites_.size(),
                      [&](std::size_t i) { judged[i] = judge(sites_[i], radius); });
    std::vector<Candidate> found;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (!judged[i]) continue;
      found.push_back(*judged[i]);
      found.back().cost += kStressCost * stress_rank_[i];
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    return found;
  }

  // The axis: the mean normal of M about the site.
  std::optional<Eigen::Vector3d> axis_at(const Site& site, double radius) const {
    Opening about{site.at, site.normal, radius, kHighest * radius, kHighest * radius};
    const Across to = across(about);
    Eigen::Vector3d sum = site.normal;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kDirections;
      const Eigen::Vector2d offset = 0.8 * radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const SurfaceHit hit = meet_surface(about, offset, 0.0, skin_);
      if (!hit.found) return std::nullopt;
      sum += skin_.field
                 .gradient(site.at + offset.x() * to.u + offset.y() * to.v +
                           (hit.along_mm - skin_.voxel_mm) * site.normal)
                 .normalized();
    }
    if (!(sum.norm() > 0.5 * kDirections)) return std::nullopt;
    return sum.normalized();
  }

  std::optional<Candidate> judge(const Site& site, double radius) const {
    for (const KeepAway& away : keep_away_)
      if ((site.at - away.point_mm).norm() < away.radius_mm + radius) return std::nullopt;
    for (const Opening& other : refused_)
      if (radius > 0.99 * other.radius_mm &&
          (site.at - other.centre_mm).norm() < kRefusedInRadii * other.radius_mm)
        return std::nullopt;
    const auto axis = axis_at(site, radius);
    if (!axis) return std::nullopt;
    const double thickness = skin_.thickness_mm;
    Opening opening{site.at, *axis, radius, kHighest * radius, kHighest * radius + 3.0 * thickness};
    const Across to = across(opening);
    const double rim = rim_radius_mm(opening, thickness);
    const double least_cosine = std::cos(kSteepestDegrees * std::numbers::pi / 180.0);
    double highest = 0.0, lowest = 0.0, deepest = 0.0;
    std::vector<Eigen::Vector3d> below;
    bool in_contact = false;
    for (const double ring : {0.0, 0.5 * radius, radius, rim, kBeyondRim * rim}) {
      for (int i = 0; i < (ring > 0.0 ? kDirections : 1); ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kDirections;
        const Eigen::Vector2d offset = ring * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        const Eigen::Vector3d foot = site.at + offset.x() * to.u + offset.y() * to.v;
        const SurfaceHit hit = meet_surface(opening, offset, 0.0, skin_);
        const SurfaceHit inner = meet_surface(opening, offset, thickness, skin_);
        if (!hit.found || !inner.found) return std::nullopt;
        const Eigen::Vector3d on = foot + hit.along_mm * *axis;
        const Eigen::Vector3d slope = skin_.field.gradient(on - skin_.voxel_mm * *axis);
        if (slope.dot(*axis) < least_cosine) return std::nullopt;
        in_contact = in_contact || on.z() <= skin_.plate_z_mm + kContactToleranceMm;
        if (ring > rim) continue;
        highest = std::max(highest, hit.along_mm);
        lowest = std::min(lowest, hit.along_mm);
        deepest = std::max(deepest, -inner.along_mm);
        below.push_back(foot);
      }
    }
    opening.clear_mm = deepest + thickness;
    opening.rise_mm = highest + thickness;
    for (const Eigen::Vector3d& foot : below) {
      if (skin_.field.at(foot - opening.clear_mm * *axis) > -thickness) return std::nullopt;
      if (skin_.field.at(foot + opening.rise_mm * *axis) <= 0.0) return std::nullopt;
    }
    const Eigen::Vector3d room = site.at - (opening.clear_mm + kRoomBelow * radius) * *axis;
    if (skin_.field.at(room) > -thickness) return std::nullopt;
    if (in_contact &&
        (hull_.size() < 3 || signed_margin_mm(hull_, site.at.head<2>()) < radius + kInContactMargin))
      return std::nullopt;
    Candidate candidate{opening, 0.5 * (1.0 + axis->z()) + kFlatCost * (highest - lowest) / radius, -1};
    for (std::size_t k = 0; k < cavities_.size() && candidate.cavity < 0; ++k)
      if (cavities_[k].tree->is_inside(room)) candidate.cavity = static_cast<int>(k);
    if (candidate.cavity < 0) return std::nullopt;
    return candidate;
  }

  // That the cut can be made is tried on M itself.
  std::optional<Opening> cheapest(std::vector<Candidate>& candidates, int cavity,
                                  const std::vector<Opening>& taken) const {
    while (true) {
      const Candidate* best = nullptr;
      double least = std::numeric_limits<double>::infinity();
      for (const Candidate& candidate : candidates) {
        if (candidate.cavity != cavity || candidate.cost >= least) continue;
        const double cost = candidate.cost + crowding(candidate.opening, taken, cavities_[cavity].diagonal);
        if (cost >= least) continue;
        least = cost;
        best = &candidate;
      }
      if (best == nullptr) return std::nullopt;
      const Opening opening = best->opening;
      for (int turn = 0; turn < kMostTurns; ++turn)
        if (cut_sheet(mesh_, opening, turn * kTurnRadians)) return opening;
      candidates.erase(candidates.begin() + (best - candidates.data()));
    }
  }

  double crowding(const Opening& opening, const std::vector<Opening>& taken, double diagonal) const {
    double cost = 0.0;
    for (const Opening& other : taken) {
      const double apart = (other.centre_mm - opening.centre_mm).norm();
      const double least = kBeyondRim * (rim_radius_mm(opening, skin_.thickness_mm) +
                                         rim_radius_mm(other, skin_.thickness_mm)) +
                           kApartMm;
      if (apart < least) return std::numeric_limits<double>::infinity();
      cost = std::max(cost, kNearCost * (1.0 - std::min(1.0, apart / diagonal)));
    }
    return cost;
  }

  std::string words(const Cavity& cavity, int count, int wanted, const OpeningRule& rule) const {
    const double least = std::min(rule.least_diameter_mm, rule.diameter_mm);
    const Opening smallest{{}, {}, 0.5 * least, 0, 0};
    return fmt::format(
        "a cavity of {:.3g} mm3 about ({:.1f}, {:.1f}, {:.1f}) mm {} {} of {} drain holes: the printer's "
        "rule "
        "asks for {:.3g} mm{}, and nowhere else its skin is flat and free over the {:.3g} mm that the "
        "smallest takes with its rim; a larger --size, or a profile with a smaller diameter_mm or "
        "least_diameter_mm in drain_holes, would help",
        cavity.volume, cavity.centre.x(), cavity.centre.y(), cavity.centre.z(),
        count == 0 ? "cannot be emptied: it has" : "has", count, wanted, rule.diameter_mm,
        least < rule.diameter_mm ? fmt::format(" ({:.3g} at least)", least) : "",
        2.0 * kBeyondRim * rim_radius_mm(smallest, skin_.thickness_mm));
  }

  const TriangleMesh& mesh_;
  const Skin& skin_;
  const Polygon2& hull_;
  const std::vector<KeepAway>& keep_away_;
  const std::vector<Opening>& refused_;
  std::vector<Site> sites_;
  std::vector<double> stress_rank_;  // 0 .. 1, one a site
  std::vector<Cavity> cavities_;     // the largest first
};

}  // namespace

PlacedOpenings place_openings(const TriangleMesh& mesh, const Skin& skin, const Polygon2& contact_hull,
                              const StressMap* stress, const OpeningRule& rule,
                              const std::vector<TriangleMesh>& cavities,
                              const std::vector<KeepAway>& keep_away, const std::vector<Opening>& refused,
                              const RunContext& context) {
  SKINFRAME_CHECK(rule.diameter_mm > 0.0 && rule.least_diameter_mm > 0.0);
  tbb::task_arena arena(std::max(1, context.threads));
  return arena.execute([&] {
    return Placing(mesh, skin, contact_hull, stress, cavities, keep_away, refused).place(rule, context);
  });
}

}  // namespace skinframe
