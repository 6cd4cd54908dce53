// SPDX-License-Identifier: GPL-3.0-or-later
// Algorithm 2 (Wang et al. 2013, section 4.5) judged from frame.json, the report and the exported meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

using Eigen::Vector3d;

constexpr double kLengthTolerance = 1e-6;  // relative
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kNormalToleranceDegrees = 0.5;
constexpr double kWallReachInSkins = 1.5;  // a node deeper than this is in no wall
constexpr double kTooNearInSkins = 0.05;   // to the surface to tell how steep it is
constexpr double kEndInSkins = 2.0;        // about its ends a support stands in the skin
constexpr double kLevelDegrees = 85;       // flatter struts are exempt from (22)
constexpr double kSolidBelowInSkins = 4.0;

double degrees_from_vertical(const Vector3d& a, const Vector3d& b) {
  const Vector3d d = b - a;
  return std::atan2(d.head<2>().norm(), std::abs(d.z())) * kDegrees;
}

// Frame and supports as one graph: pieces of struts between the nodes that divide them, and supports.
class Print {
 public:
  Print(const ExportedPrinter& result, const Surface& outer)
      : result_(result),
        supports_(*result.supports),
        outer_(outer),
        own_(result.frame.nodes_mm.size()),
        nodes_(result.frame.nodes_mm) {
    for (const ExportedSupportNode& node : supports_.nodes) nodes_.push_back(node.at_mm);
    pieces_of_.resize(result.frame.struts.size());
    for (std::size_t j = 0; j < pieces_of_.size(); ++j) pieces_of_[j] = {result.frame.struts[j].a};
    for (std::size_t i = 0; i < supports_.nodes.size(); ++i)
      if (supports_.nodes[i].strut >= 0)
        pieces_of_[supports_.nodes[i].strut].push_back(static_cast<int>(own_ + i));
    for (std::size_t j = 0; j < pieces_of_.size(); ++j) {
      auto& list = pieces_of_[j];
      const Vector3d from = nodes_[result.frame.struts[j].a];
      std::sort(list.begin() + 1, list.end(),
                [&](int p, int q) { return (nodes_[p] - from).norm() < (nodes_[q] - from).norm(); });
      list.push_back(result.frame.struts[j].b);
    }
  }

  bool prints(int a, int b) const {
    const double printable =
        printable_mm(supports_.printable_length, degrees_from_vertical(nodes_[a], nodes_[b]));
    return (nodes_[a] - nodes_[b]).norm() <= printable * (1 + kLengthTolerance);
  }

  void claim_lengths(Verdict* verdict) const {
    int too_long = 0, off = 0, divided = 0, unsound = 0;
    for (std::size_t j = 0; j < pieces_of_.size(); ++j) {
      const auto& list = pieces_of_[j];
      const Vector3d &a = nodes_[list.front()], &b = nodes_[list.back()];
      divided += list.size() > 2;
      for (std::size_t k = 0; k + 1 < list.size(); ++k) {
        too_long += !prints(list[k], list[k + 1]);
        if (k == 0) continue;
        const Vector3d wanted = a + static_cast<double>(k) / static_cast<double>(list.size() - 1) * (b - a);
        off += (nodes_[list[k]] - wanted).norm() > 1e-6 * (b - a).norm();
      }
    }
    for (const ExportedSupportStrut& s : supports_.struts)
      unsound += !prints(s.upper, s.lower) || !(nodes_[s.lower].z() < nodes_[s.upper].z()) ||
                 degrees_from_vertical(nodes_[s.upper], nodes_[s.lower]) >
                     supports_.self_supporting_angle_deg + 1e-6;
    verdict->claims.push_back(
        {"struts print without more support", too_long + off + unsound == 0,
         fmt::format(
             "{} of {} struts divided; {} pieces longer than the printable length of their angle, {} "
             "inserted nodes off their place, {} of {} supports too long or flatter than {:g} degrees "
             "from the vertical",
             divided, pieces_of_.size(), too_long, off, unsound, supports_.struts.size(),
             supports_.self_supporting_angle_deg)});
  }

  void claim_ways_down(Verdict* verdict) const {
    std::vector<std::vector<int>> lower(nodes_.size());
    for (const ExportedSupportStrut& s : supports_.struts)
      if (nodes_[s.lower].z() < nodes_[s.upper].z()) lower[s.upper].push_back(s.lower);
    for (const auto& list : pieces_of_)
      for (std::size_t k = 0; k + 1 < list.size(); ++k)
        for (const auto& [from, to] : {std::pair(list[k], list[k + 1]), std::pair(list[k + 1], list[k])})
          if (from < static_cast<int>(own_) && nodes_[to].z() < nodes_[from].z() && prints(from, to))
            lower[from].push_back(to);
    // From below upwards: each way leads to a node that is judged already.
    std::vector<int> order(nodes_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::sort(order.begin(), order.end(), [&](int p, int q) { return nodes_[p].z() < nodes_[q].z(); });
    std::vector<bool> held(nodes_.size(), false);
    int in_the_air = 0, by_skin = 0;
    for (const int node : order) {
      for (const int below : lower[node]) held[node] = held[node] || held[below];
      if (!held[node]) {
        const bool skin = on_plate(node) || is_foot(node) || held_by_skin(node, Ask::kPossibly);
        by_skin += skin && !on_plate(node);
        held[node] = skin;
      }
      in_the_air += !held[node];
    }
    verdict->claims.push_back(
        {"every node has a way down", in_the_air == 0,
         fmt::format("{} of {} nodes have no path of printable struts down to the base plane or to skin that "
                     "holds them; the skin holds {}",
                     in_the_air, nodes_.size(), by_skin)});
  }

  void claim_need(Verdict* verdict) const {
    std::vector<int> ways(nodes_.size(), 0);
    for (const ExportedSupportStrut& s : supports_.struts) ++ways[s.upper];
    std::vector<bool> hangs(own_, true);
    for (const auto& list : pieces_of_)
      for (std::size_t k = 0; k + 1 < list.size(); ++k)
        for (const auto& [from, to] : {std::pair(list[k], list[k + 1]), std::pair(list[k + 1], list[k])})
          if (from < static_cast<int>(own_) && nodes_[to].z() < nodes_[from].z() - 1e-6) hangs[from] = false;
    int useless = 0;
    for (const ExportedSupportStrut& s : supports_.struts) {
      bool needed = ways[s.upper] == 1;
      if (is_joint(s.upper)) {
        // What comes down to a joint goes on to the foot, unless it is within a wall that holds it.
        needed = needed && (s.external || !in_steep_wall(s.upper, Ask::kSurely));
      } else {
        // One that holds the skin stands where the skin ends below, be it the edge of a steep wall.
        needed =
            needed && !on_plate(s.upper) &&
            !(holds_skin(s.upper) ? solid_below(s.upper, Ask::kSurely) : held_by_skin(s.upper, Ask::kSurely));
      }
      if (s.upper < static_cast<int>(own_)) {
        needed = needed && hangs[s.upper];
      } else if (const int j = supports_.nodes[s.upper - own_].strut; j >= 0) {
        const auto& list = pieces_of_[j];
        const auto at = std::find(list.begin(), list.end(), s.upper);
        needed = needed && !prints(*(at - 1), *(at + 1));  // without it the two pieces are one
      }
      useless += !needed;
    }
    verdict->claims.push_back(
        {"no support is useless", useless == 0,
         fmt::format(
             "{} of {} supports could go: without any other one a strut would be longer than prints, or a "
             "node would have no way down",
             useless, supports_.struts.size())});
  }

  void claim_sides(Verdict* verdict) const {
    const double h = result_.skin_thickness_mm, tolerance = 0.4 * h, end = kEndInSkins * h;
    int astray = 0;
    double worst = std::numeric_limits<double>::infinity();
    for (const ExportedSupportStrut& s : supports_.struts) {
      const Vector3d &a = nodes_[s.upper], &b = nodes_[s.lower];
      const double length = (b - a).norm();
      double least = std::numeric_limits<double>::infinity();
      for (double t = end; t <= length - end; t += std::max(0.5 * h, length / 200)) {
        const double depth = outer_.depth_mm(a + t / length * (b - a));
        least = std::min(least, s.external ? -depth : depth);
      }
      worst = std::min(worst, least);
      astray += least < -tolerance;
    }
    verdict->claims.push_back(
        {"supports stay on their side of the skin", astray == 0,
         fmt::format("{} of {} supports pass through the surface by more than {:.2f} mm; {}", astray,
                     supports_.struts.size(), tolerance,
                     std::isinf(worst)
                         ? std::string("all are short")
                         : fmt::format("the least distance on the right side is {:.3f} mm", worst))});
  }

  void claim_figures(Verdict* verdict) const {
    int external = 0;
    double length = 0;
    for (const ExportedSupportStrut& s : supports_.struts) {
      external += s.external;
      length += (nodes_[s.upper] - nodes_[s.lower]).norm();
    }
    const int count = static_cast<int>(supports_.struts.size());
    const double inside = signed_volume(supports_.internal_mesh),
                 outside = signed_volume(supports_.external_mesh);
    const double all = signed_volume(supports_.all_mesh), weight = all * result_.density_g_cm3 * 1e-3;
    const auto same = [](double measured, double reported) {
      return std::abs(measured - reported) <= 1e-4 * std::max(std::abs(measured), std::abs(reported)) + 1e-9;
    };
    std::size_t open = 0;
    for (const TriangleMesh* mesh :
         {&supports_.all_mesh, &supports_.internal_mesh, &supports_.external_mesh}) {
      const EdgeCount edges = count_edges(*mesh);
      open += edges.unmatched + edges.degenerate;
    }
    verdict->claims.push_back(
        {"support figures",
         count == supports_.count && external == supports_.external &&
             count - external == supports_.internal && same(length, supports_.length_mm) &&
             same(all, supports_.volume_mm3) && same(inside, supports_.internal_volume_mm3) &&
             same(outside, supports_.external_volume_mm3) && same(inside + outside, all) &&
             same(weight, supports_.weight_g),
         fmt::format(
             "{} struts, {} of them external, {:.1f} mm, {:.1f} mm3 in the exported meshes ({:.1f} inside, "
             "{:.1f} outside), {:.3f} g; reported {}, {}, {:.1f}, {:.1f} ({:.1f}, {:.1f}), {:.3f}",
             count, external, length, all, inside, outside, weight, supports_.count, supports_.external,
             supports_.length_mm, supports_.volume_mm3, supports_.internal_volume_mm3,
             supports_.external_volume_mm3, supports_.weight_g)});
    verdict->claims.push_back({"supports are watertight", open == 0,
                               fmt::format("{} edges without their opposite or collapsed triangles in the "
                                           "support meshes",
                                           open)});
  }

  // (22), under self weight in the print state: the structure assembled anew.
  void claim_print_state(Verdict* verdict) const {
    ExportedFrame print = result_.frame;
    print.nodes_mm = nodes_;
    print.struts.clear();
    std::set<std::pair<int, int>> joined;
    const auto join = [&](int a, int b, double radius) {
      if (a != b && joined.insert({std::min(a, b), std::max(a, b)}).second)
        print.struts.push_back({a, b, false, radius, 0, 0});
    };
    for (std::size_t j = 0; j < pieces_of_.size(); ++j)
      for (std::size_t k = 0; k + 1 < pieces_of_[j].size(); ++k)
        join(pieces_of_[j][k], pieces_of_[j][k + 1], result_.frame.struts[j].radius_mm);
    for (const ExportedSupportStrut& s : supports_.struts) join(s.upper, s.lower, s.radius_mm);
    print.fixed.resize(nodes_.size(), {false, false, false});
    for (std::size_t i = 0; i < own_; ++i)
      if (print.fixed[i][2]) print.fixed[i] = {true, true, true};
    print.skin_weight_n.resize(nodes_.size(), 0.0);
    std::set<int> skin;
    for (const auto& t : result_.frame.skin_triangles) skin.insert(t.begin(), t.end());
    for (std::size_t i = 0; i < supports_.nodes.size(); ++i) {
      const ExportedSupportNode& node = supports_.nodes[i];
      if (node.on == "plate") print.fixed[own_ + i] = {true, true, true};
      if (node.on != "skin" && node.on != "roof") continue;
      std::vector<std::pair<double, int>> near;
      for (const int v : skin) near.emplace_back((nodes_[v] - node.at_mm).squaredNorm(), v);
      std::sort(near.begin(), near.end());
      for (std::size_t k = 0; k < std::min<std::size_t>(3, near.size()); ++k)
        join(static_cast<int>(own_ + i), near[k].second, supports_.skin_tie_radius_mm);
    }
    double worst = 0;
    const auto displacements = own_weight_displacements_mm(print);
    for (const ExportedStrut& s : print.struts)
      if (!displacements.empty() && degrees_from_vertical(nodes_[s.a], nodes_[s.b]) <= kLevelDegrees)
        worst = std::max(worst, std::abs(displacements[s.a].z() - displacements[s.b].z()));
    const double reported = supports_.worst_vertical_deformation_mm;
    verdict->claims.push_back(
        {"deformation while printing (paper model)",
         !displacements.empty() && std::abs(worst - reported) <= 1e-4 * std::max(worst, reported) + 1e-9,
         fmt::format(
             "the worst vertical deformation of a strut under self weight is {:.3g} mm, reported {:.3g} mm{}",
             worst, reported,
             supports_.deformation_limit_mm ? fmt::format(", limit {:g} mm", *supports_.deformation_limit_mm)
                                            : std::string())});
  }

 private:
  // Whether it may be so, as far as two programs agree about a distance, or cannot be otherwise.
  enum class Ask { kPossibly, kSurely };

  bool on_plate(int node) const {
    if (node >= static_cast<int>(own_) && supports_.nodes[node - own_].on == "plate")
      return std::abs(nodes_[node].z() - supports_.plate_z_mm) <= 1e-6;
    return nodes_[node].z() <= supports_.plate_z_mm + supports_.plate_reach_mm + 1e-9;
  }
  // A foot on the skin stands in it.
  bool is_foot(int node) const {
    if (node < static_cast<int>(own_) || supports_.nodes[node - own_].on != "skin") return false;
    const double depth = outer_.depth_mm(nodes_[node]), h = result_.skin_thickness_mm;
    return depth >= -0.6 * h && depth <= 1.1 * h;
  }
  // Within M, in or at a wall no flatter than the self-supporting angle.
  bool in_steep_wall(int node, Ask ask) const {
    const Vector3d &p = nodes_[node], q = outer_.nearest(p);
    const double h = result_.skin_thickness_mm, distance = (q - p).norm();
    const double room = ask == Ask::kPossibly ? 1.0 : -1.0;
    if (distance <= kTooNearInSkins * h) return ask == Ask::kPossibly;
    if (outer_.depth_mm(p) < 0.0 || distance > (kWallReachInSkins + 0.01 * room) * h) return false;
    const double flatness = std::asin(std::clamp(std::abs(q.z() - p.z()) / distance, 0.0, 1.0)) * kDegrees;
    return flatness <= supports_.self_supporting_angle_deg + room * kNormalToleranceDegrees;
  }
  // The material below does not end for kSolidBelowInSkins.
  bool solid_below(int node, Ask ask) const {
    const double h = result_.skin_thickness_mm, room = (ask == Ask::kPossibly ? 0.2 : -0.2) * h;
    for (double s = 0.5 * h; s <= kSolidBelowInSkins * h - room; s += 0.25 * h) {
      const Vector3d p = nodes_[node] - Vector3d(0, 0, s);
      const double depth = outer_.depth_mm(p);
      if (p.z() > supports_.plate_z_mm && (depth > 1.1 * h + room || depth < -0.1 * h - room)) return false;
    }
    return true;
  }
  bool held_by_skin(int node, Ask ask) const { return in_steep_wall(node, ask) || solid_below(node, ask); }

  bool holds_skin(int node) const {
    return node >= static_cast<int>(own_) && supports_.nodes[node - own_].on == "roof";
  }
  // A node along a support, and nothing that is to be held for its own sake.
  bool is_joint(int node) const {
    return node >= static_cast<int>(own_) && supports_.nodes[node - own_].on == "support";
  }

  const ExportedPrinter& result_;
  const ExportedSupports& supports_;
  const Surface& outer_;
  std::size_t own_;
  std::vector<Vector3d> nodes_;
  std::vector<std::vector<int>> pieces_of_;  // one list of nodes a strut of the frame
};

}  // namespace

double printable_mm(const std::vector<std::pair<double, double>>& curve, double degrees) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const auto& [angle, length] = curve[i];
    if (degrees > angle + 1e-9) continue;
    if (i == 0 || degrees >= angle - 1e-9) return length;
    const auto& [steeper, longer] = curve[i - 1];
    if (std::isinf(longer)) return length;
    return longer + (length - longer) * (degrees - steeper) / (angle - steeper);
  }
  return curve.back().second;
}

void claim_supports(const ExportedPrinter& result, const Surface& outer, Verdict* verdict) {
  const Print print(result, outer);
  print.claim_lengths(verdict);
  print.claim_ways_down(verdict);
  print.claim_need(verdict);
  print.claim_sides(verdict);
  print.claim_figures(verdict);
  print.claim_print_state(verdict);
}

}  // namespace skinframe::check
