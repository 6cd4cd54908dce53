// SPDX-License-Identifier: GPL-3.0-or-later
// Algorithm 2 (Wang et al. 2013, section 4.5) judged from frame.json, the report and the exported meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "worker/check/claims.h"
#include "worker/check/support_graph.h"

namespace skinframe::check {
namespace {

using Eigen::Vector3d;

constexpr double kEndInSkins = 2.0;   // about its ends a support stands in the skin
constexpr double kLevelDegrees = 85;  // flatter struts are exempt from (22)

void claim_lengths(const SupportGraph& print, Verdict* verdict) {
  int too_long = 0, off = 0, divided = 0, unsound = 0;
  for (std::size_t j = 0; j < print.pieces().size(); ++j) {
    const auto& list = print.pieces()[j];
    const Vector3d &a = print.nodes()[list.front()], &b = print.nodes()[list.back()];
    divided += list.size() > 2;
    for (std::size_t k = 0; k + 1 < list.size(); ++k) {
      too_long += !print.prints(list[k], list[k + 1]);
      if (k == 0) continue;
      const Vector3d wanted = a + static_cast<double>(k) / static_cast<double>(list.size() - 1) * (b - a);
      off += (print.nodes()[list[k]] - wanted).norm() > 1e-6 * (b - a).norm();
    }
  }
  for (const ExportedSupportStrut& s : print.supports().struts)
    unsound += !print.prints(s.upper, s.lower) ||
               !(print.nodes()[s.lower].z() < print.nodes()[s.upper].z()) ||
               degrees_from_vertical(print.nodes()[s.upper], print.nodes()[s.lower]) >
                   print.supports().self_supporting_angle_deg + 1e-6;
  verdict->claims.push_back(
      {"struts print without more support", too_long + off + unsound == 0,
       fmt::format("{} of {} struts divided; {} pieces longer than the printable length of their angle, {} "
                   "inserted nodes off their place, {} of {} supports too long or flatter than {:g} degrees "
                   "from the vertical",
                   divided, print.pieces().size(), too_long, off, unsound, print.supports().struts.size(),
                   print.supports().self_supporting_angle_deg)});
}

void claim_ways_down(const SupportGraph& print, Verdict* verdict) {
  std::vector<std::vector<int>> lower(print.nodes().size());
  for (const ExportedSupportStrut& s : print.supports().struts)
    if (print.nodes()[s.lower].z() < print.nodes()[s.upper].z()) lower[s.upper].push_back(s.lower);
  for (const auto& list : print.pieces())
    for (std::size_t k = 0; k + 1 < list.size(); ++k)
      for (const auto& [from, to] : {std::pair(list[k], list[k + 1]), std::pair(list[k + 1], list[k])})
        if (from < static_cast<int>(print.own()) && print.nodes()[to].z() < print.nodes()[from].z() &&
            print.prints(from, to))
          lower[from].push_back(to);
  // From below upwards: each way leads to a node that is judged already.
  std::vector<int> order(print.nodes().size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(),
            [&](int p, int q) { return print.nodes()[p].z() < print.nodes()[q].z(); });
  std::vector<bool> held(print.nodes().size(), false);
  int in_the_air = 0, by_skin = 0;
  for (const int node : order) {
    for (const int below : lower[node]) held[node] = held[node] || held[below];
    if (!held[node]) {
      const bool skin = print.on_plate(node) || print.is_foot(node) ||
                        print.held_by_skin(node, SupportGraph::Ask::kPossibly);
      by_skin += skin && !print.on_plate(node);
      held[node] = skin;
    }
    in_the_air += !held[node];
  }
  verdict->claims.push_back(
      {"every node has a way down", in_the_air == 0,
       fmt::format("{} of {} nodes have no path of printable struts down to the base plane or to skin that "
                   "holds them; the skin holds {}",
                   in_the_air, print.nodes().size(), by_skin)});
}

void claim_need(const SupportGraph& print, Verdict* verdict) {
  std::vector<int> ways(print.nodes().size(), 0);
  for (const ExportedSupportStrut& s : print.supports().struts) ++ways[s.upper];
  std::vector<bool> hangs(print.own(), true);
  for (const auto& list : print.pieces())
    for (std::size_t k = 0; k + 1 < list.size(); ++k)
      for (const auto& [from, to] : {std::pair(list[k], list[k + 1]), std::pair(list[k + 1], list[k])})
        if (from < static_cast<int>(print.own()) && print.nodes()[to].z() < print.nodes()[from].z() - 1e-6)
          hangs[from] = false;
  int useless = 0;
  for (const ExportedSupportStrut& s : print.supports().struts) {
    bool needed = ways[s.upper] == 1;
    if (print.is_joint(s.upper)) {
      // What comes down to a joint goes on to the foot, unless it is within a wall that holds it.
      needed = needed && (s.external || !print.in_steep_wall(s.upper, SupportGraph::Ask::kSurely));
    } else {
      // One that holds the skin stands where the skin ends below, be it the edge of a steep wall.
      needed = needed && !print.on_plate(s.upper) &&
               !(print.holds_skin(s.upper) ? print.solid_below(s.upper, SupportGraph::Ask::kSurely)
                                           : print.held_by_skin(s.upper, SupportGraph::Ask::kSurely));
    }
    if (s.upper < static_cast<int>(print.own())) {
      needed = needed && hangs[s.upper];
    } else if (const int j = print.supports().nodes[s.upper - print.own()].strut; j >= 0) {
      const auto& list = print.pieces()[j];
      const auto at = std::find(list.begin(), list.end(), s.upper);
      needed = needed && !print.prints(*(at - 1), *(at + 1));  // without it the two pieces are one
    }
    useless += !needed;
  }
  verdict->claims.push_back(
      {"no support is useless", useless == 0,
       fmt::format(
           "{} of {} supports could go: without any other one a strut would be longer than prints, or a "
           "node would have no way down",
           useless, print.supports().struts.size())});
}

void claim_sides(const SupportGraph& print, Verdict* verdict) {
  const double h = print.result().skin_thickness_mm, tolerance = 0.4 * h, end = kEndInSkins * h;
  int astray = 0;
  double worst = std::numeric_limits<double>::infinity();
  for (const ExportedSupportStrut& s : print.supports().struts) {
    const Vector3d &a = print.nodes()[s.upper], &b = print.nodes()[s.lower];
    const double length = (b - a).norm();
    double least = std::numeric_limits<double>::infinity();
    for (double t = end; t <= length - end; t += std::max(0.5 * h, length / 200)) {
      const double depth = print.outer().depth_mm(a + t / length * (b - a));
      least = std::min(least, s.external ? -depth : depth);
    }
    worst = std::min(worst, least);
    astray += least < -tolerance;
  }
  verdict->claims.push_back(
      {"supports stay on their side of the skin", astray == 0,
       fmt::format("{} of {} supports pass through the surface by more than {:.2f} mm; {}", astray,
                   print.supports().struts.size(), tolerance,
                   std::isinf(worst)
                       ? std::string("all are short")
                       : fmt::format("the least distance on the right side is {:.3f} mm", worst))});
}

void claim_figures(const SupportGraph& print, Verdict* verdict) {
  int external = 0;
  double length = 0;
  for (const ExportedSupportStrut& s : print.supports().struts) {
    external += s.external;
    length += (print.nodes()[s.upper] - print.nodes()[s.lower]).norm();
  }
  const int count = static_cast<int>(print.supports().struts.size());
  const double inside = signed_volume(print.supports().internal_mesh),
               outside = signed_volume(print.supports().external_mesh);
  const double all = signed_volume(print.supports().all_mesh),
               weight = all * print.result().density_g_cm3 * 1e-3;
  const auto same = [](double measured, double reported) {
    return std::abs(measured - reported) <= 1e-4 * std::max(std::abs(measured), std::abs(reported)) + 1e-9;
  };
  std::size_t open = 0;
  for (const TriangleMesh* mesh :
       {&print.supports().all_mesh, &print.supports().internal_mesh, &print.supports().external_mesh}) {
    const EdgeCount edges = count_edges(*mesh);
    open += edges.unmatched + edges.degenerate;
  }
  verdict->claims.push_back(
      {"support figures",
       count == print.supports().count && external == print.supports().external &&
           count - external == print.supports().internal && same(length, print.supports().length_mm) &&
           same(all, print.supports().volume_mm3) && same(inside, print.supports().internal_volume_mm3) &&
           same(outside, print.supports().external_volume_mm3) && same(inside + outside, all) &&
           same(weight, print.supports().weight_g),
       fmt::format(
           "{} struts, {} of them external, {:.1f} mm, {:.1f} mm3 in the exported meshes ({:.1f} inside, "
           "{:.1f} outside), {:.3f} g; reported {}, {}, {:.1f}, {:.1f} ({:.1f}, {:.1f}), {:.3f}",
           count, external, length, all, inside, outside, weight, print.supports().count,
           print.supports().external, print.supports().length_mm, print.supports().volume_mm3,
           print.supports().internal_volume_mm3, print.supports().external_volume_mm3,
           print.supports().weight_g)});
  verdict->claims.push_back({"supports are watertight", open == 0,
                             fmt::format("{} edges without their opposite or collapsed triangles in the "
                                         "support meshes",
                                         open)});
}

// (22), under self weight in the print state: the structure assembled anew.
void claim_print_state(const SupportGraph& print, Verdict* verdict) {
  ExportedFrame printed = print.result().frame;
  printed.nodes_mm = print.nodes();
  printed.struts.clear();
  std::set<std::pair<int, int>> joined;
  const auto join = [&](int a, int b, double radius) {
    if (a != b && joined.insert({std::min(a, b), std::max(a, b)}).second)
      printed.struts.push_back({a, b, false, radius, 0, 0});
  };
  for (std::size_t j = 0; j < print.pieces().size(); ++j)
    for (std::size_t k = 0; k + 1 < print.pieces()[j].size(); ++k)
      join(print.pieces()[j][k], print.pieces()[j][k + 1], print.result().frame.struts[j].radius_mm);
  for (const ExportedSupportStrut& s : print.supports().struts) join(s.upper, s.lower, s.radius_mm);
  printed.fixed.resize(print.nodes().size(), {false, false, false});
  for (std::size_t i = 0; i < print.own(); ++i)
    if (printed.fixed[i][2]) printed.fixed[i] = {true, true, true};
  printed.skin_weight_n.resize(print.nodes().size(), 0.0);
  std::set<int> skin;
  for (const auto& t : print.result().frame.skin_triangles) skin.insert(t.begin(), t.end());
  for (std::size_t i = 0; i < print.supports().nodes.size(); ++i) {
    const ExportedSupportNode& node = print.supports().nodes[i];
    if (node.on == "plate") printed.fixed[print.own() + i] = {true, true, true};
    if (node.on != "skin" && node.on != "roof") continue;
    std::vector<std::pair<double, int>> near;
    for (const int v : skin) near.emplace_back((print.nodes()[v] - node.at_mm).squaredNorm(), v);
    std::sort(near.begin(), near.end());
    for (std::size_t k = 0; k < std::min<std::size_t>(3, near.size()); ++k)
      join(static_cast<int>(print.own() + i), near[k].second, print.supports().skin_tie_radius_mm);
  }
  double worst = 0;
  const auto displacements = own_weight_displacements_mm(printed);
  for (const ExportedStrut& s : printed.struts)
    if (!displacements.empty() &&
        degrees_from_vertical(print.nodes()[s.a], print.nodes()[s.b]) <= kLevelDegrees)
      worst = std::max(worst, std::abs(displacements[s.a].z() - displacements[s.b].z()));
  const double reported = print.supports().worst_vertical_deformation_mm;
  verdict->claims.push_back(
      {"deformation while printing (paper model)",
       !displacements.empty() && std::abs(worst - reported) <= 1e-4 * std::max(worst, reported) + 1e-9,
       fmt::format(
           "the worst vertical deformation of a strut under self weight is {:.3g} mm, reported {:.3g} mm{}",
           worst, reported,
           print.supports().deformation_limit_mm
               ? fmt::format(", limit {:g} mm", *print.supports().deformation_limit_mm)
               : std::string())});
}

}  // namespace

void claim_supports(const ExportedPrinter& result, const Surface& outer, Verdict* verdict) {
  const SupportGraph print(result, outer);
  claim_lengths(print, verdict);
  claim_ways_down(print, verdict);
  claim_need(print, verdict);
  claim_sides(print, verdict);
  claim_figures(print, verdict);
  claim_print_state(print, verdict);
}

}  // namespace skinframe::check
