// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/plan_supports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "worker/frame/point_tree.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using On = SupportNode::On;

constexpr double kLowerMm = 1e-6;        // a node is below another one from here on
constexpr double kShortestMm = 1e-3;     // no strut is shorter
constexpr int kPlacesOnSupport = 64;     // looked at along each support there is
constexpr double kPlaceSpacingMm = 1.0;  // and no nearer to each other
// Below M a strut within it is preferred up to this length: it does not have to be broken off.
constexpr double kMostReachInSkins = 25.0;

// A support while others may still end on it: joints are nodes along it, from its upper end down.
struct Support {
  int upper, lower;
  SupportKind kind;
  std::vector<int> joints;
};

class Planner {
 public:
  Planner(const Frame& frame, const PrintableLength& curve, const PrintedBody& body,
          const SupportOptions& options)
      : frame_(frame),
        curve_(curve),
        body_(body),
        options_(options),
        points_(frame.nodes_mm),
        flattest_(self_supporting_angle(curve)) {}

  Result<SupportPlan> run(const RunContext& context) {
    if (auto divided = divide(); !divided) return divided.error();
    for (const Vector3d& point : options_.roof_points) add_node({point, On::kRoof, -1});
    first_of_supports_ = points_.size();
    const PointTree tree(points_);
    const std::vector<int> to_hold = nodes_to_hold();
    for (const int node : to_hold) {
      if (context.cancelled()) return cancelled_error();
      if (auto held = hold(node, tree); !held) return held.error();
      if (plan_.nodes.size() > options_.most_nodes) return too_many();
    }
    return finish();
  }

 private:
  // Feet and joints of supports: within M no strut ends on one outside.
  bool is_of_other_kind(int node, int support, SupportKind kind) const {
    if (support >= 0) return supports_[support].kind != kind;
    return node >= static_cast<int>(first_of_supports_) && foot_kind_[node - first_of_supports_] != kind;
  }

  int add_node(const SupportNode& node) {
    points_.push_back(node.at_mm);
    plan_.nodes.push_back(node);
    return static_cast<int>(points_.size()) - 1;
  }
  Error too_many() const {
    return invalid_input(fmt::format(
        "more than {} nodes would be needed on struts that are too long to print: use a printer profile that "
        "prints longer struts, a smaller --size or more --skin-nodes",
        options_.most_nodes));
  }

  Status divide() {
    for (int j = 0; j < static_cast<int>(frame_.struts.size()); ++j) {
      const Strut& strut = frame_.struts[j];
      const Vector3d &a = frame_.nodes_mm[strut.a], &b = frame_.nodes_mm[strut.b];
      if (prints(curve_, a, b)) continue;
      const double printable = curve_.length_mm(angle_from_vertical(a, b));
      const double pieces = std::ceil((b - a).norm() / printable * (1.0 - kLengthTolerance));
      if (pieces + plan_.nodes.size() > options_.most_nodes) return too_many();
      for (int k = 1; k < pieces; ++k) add_node({a + k / pieces * (b - a), On::kStrut, j});
    }
    return ok_status();
  }

  // Inserted nodes, roof points, and nodes of the frame that hang; the highest first, so that lower ones find
  // supports to end on.
  std::vector<int> nodes_to_hold() const {
    std::vector<int> nodes;
    std::vector<bool> has_way_down(frame_.nodes_mm.size(), false);
    for (const Strut& strut : frame_.struts) {
      const double rise = frame_.nodes_mm[strut.b].z() - frame_.nodes_mm[strut.a].z();
      if (std::abs(rise) > kLowerMm) has_way_down[rise > 0 ? strut.b : strut.a] = true;
    }
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (i >= has_way_down.size() || !has_way_down[i]) nodes.push_back(static_cast<int>(i));
    std::stable_sort(nodes.begin(), nodes.end(),
                     [&](int a, int b) { return points_[a].z() > points_[b].z(); });
    return nodes;
  }

  int strut_of(int node) const {
    const int own = static_cast<int>(frame_.nodes_mm.size());
    return node < own ? -1 : plan_.nodes[node - own].strut;
  }
  bool holds_skin(int node) const {
    const int own = static_cast<int>(frame_.nodes_mm.size());
    return node >= own && plan_.nodes[node - own].on == On::kRoof;
  }
  bool on_same_strut(int node, int other) const {
    const int j = strut_of(node);
    return j >= 0 && (strut_of(other) == j || frame_.struts[j].a == other || frame_.struts[j].b == other);
  }

  bool supports_itself(const Vector3d& upper, const Vector3d& lower) const {
    return upper.z() - lower.z() > kLowerMm && (upper - lower).norm() > kShortestMm &&
           angle_from_vertical(upper, lower) <= flattest_ && prints(curve_, upper, lower);
  }

  struct Foot {
    double length = std::numeric_limits<double>::infinity();
    SupportKind kind = SupportKind::kInternal;
    int node = -1;     // that is there already, or
    int support = -1;  // a place on this support, or a new footing
    Vector3d at = Vector3d::Zero();
    On on = On::kSupport;
  };

  // The first of the candidates, nearest first, whose strut stays on the wanted side.
  std::optional<Foot> first_on_side(const Vector3d& from, std::vector<Foot>& candidates,
                                    SupportKind side) const {
    std::sort(candidates.begin(), candidates.end(), [](const Foot& a, const Foot& b) {
      const bool new_a = a.node < 0, new_b = b.node < 0;
      return std::tie(a.length, new_a, a.node, a.support) < std::tie(b.length, new_b, b.node, b.support);
    });
    for (const Foot& foot : candidates)
      if (!is_of_other_kind(foot.node, foot.support, side) && side_of_segment(body_, from, foot.at) == side)
        return foot;
    return std::nullopt;
  }

  Status hold(int node, const PointTree& tree) {
    const Vector3d at = points_[node];
    const bool inserted = node >= static_cast<int>(frame_.nodes_mm.size());
    if (at.z() <= body_.plate_z_mm + options_.plate_reach_mm) {
      plan_.held_by_plate += inserted;
      return ok_status();
    }
    const auto below = footing_below(body_, at);
    // A roof point was chosen because the skin there overhangs: the lower edge of a thin wall does, though
    // the wall beside it is steep.
    if (!below || (!holds_skin(node) && is_in_steep_wall(body_, at, flattest_))) {
      plan_.held_by_wall += inserted;
      return ok_status();
    }
    Foot best{(at - below->at_mm).norm(),
              below->kind,
              -1,
              -1,
              below->at_mm,
              below->on_plate ? On::kPlate : On::kSkin};
    // What stays within M comes first: outside only where the upright line leads there and nothing within
    // serves.
    const bool outside = below->kind == SupportKind::kExternal;
    const double reach_within = outside ? kMostReachInSkins * body_.skin_thickness_mm : best.length;
    std::vector<Foot> candidates = candidates_below(node, at, reach_within, tree);
    if (auto foot = first_on_side(at, candidates, SupportKind::kInternal)) {
      best = *foot;
    } else if (outside) {
      candidates = candidates_below(node, at, best.length, tree);
      if (auto other = first_on_side(at, candidates, SupportKind::kExternal)) best = *other;
      best.kind = SupportKind::kExternal;
    }
    return add_support(node, best);
  }

  std::vector<Foot> candidates_below(int node, const Vector3d& at, double reach,
                                     const PointTree& tree) const {
    std::vector<Foot> out;
    const auto consider = [&](const Vector3d& place, int other, int support) {
      const double length = (place - at).norm();
      if (length < reach && supports_itself(at, place))
        out.push_back({length, SupportKind::kInternal, other, support, place, On::kSupport});
    };
    for (const int other : tree.within(at, reach))
      if (other != node && !on_same_strut(node, other)) consider(points_[other], other, -1);
    for (int s = 0; s < static_cast<int>(supports_.size()); ++s) {
      const Vector3d &upper = points_[supports_[s].upper], &lower = points_[supports_[s].lower];
      const double length = (lower - upper).norm();
      const int places = std::clamp(static_cast<int>(length / kPlaceSpacingMm), 1, kPlacesOnSupport);
      for (int k = 1; k < places; ++k)
        consider(upper + static_cast<double>(k) / places * (lower - upper), -1, s);
    }
    // Feet and joints of earlier supports.
    for (int other = static_cast<int>(first_of_supports_); other < static_cast<int>(points_.size()); ++other)
      consider(points_[other], other, -1);
    return out;
  }

  Status add_support(int node, const Foot& foot) {
    const auto add_foot = [&](const Vector3d& at, On on) {
      foot_kind_.push_back(foot.kind);
      return add_node({at, on, -1});
    };
    const int lower = foot.node >= 0 ? foot.node : add_foot(foot.at, foot.on);
    if (foot.support >= 0) supports_[foot.support].joints.push_back(lower);
    supports_.push_back({node, lower, foot.kind, {}});
    const Vector3d upper_at = points_[node], lower_at = points_[lower];
    if (prints(curve_, upper_at, lower_at)) return ok_status();
    const double printable = curve_.length_mm(angle_from_vertical(upper_at, lower_at));
    const double pieces = std::ceil((lower_at - upper_at).norm() / printable * (1.0 - kLengthTolerance));
    if (pieces + plan_.nodes.size() > options_.most_nodes) return too_many();
    for (int k = 1; k < pieces; ++k)
      supports_.back().joints.push_back(
          add_foot(upper_at + k / pieces * (lower_at - upper_at), On::kSupport));
    return ok_status();
  }

  // A joint of a support within M that stands in a steep wall: what comes down to it needs no more.
  bool ends_in_wall(const Support& s, int joint) const {
    return s.kind == SupportKind::kInternal && joint != s.lower &&
           is_in_steep_wall(body_, points_[joint], flattest_);
  }

  // The struts of a support, but for those below a wall that carry nothing. `loaded`: nodes that a support
  // finished before comes down to.
  std::vector<SupportStrut> struts_of(Support& s, std::vector<bool>& loaded) {
    std::sort(s.joints.begin(), s.joints.end(),
              [&](int a, int b) { return points_[a].z() > points_[b].z(); });
    s.joints.push_back(s.lower);
    std::vector<SupportStrut> struts;
    bool carries = true;
    int upper = s.upper, top = s.upper;  // of this piece, and of the pieces in one with it
    std::size_t first = 0;
    const auto size_pieces = [&](int end) {
      const double length = (points_[top] - points_[end]).norm();
      const double radius =
          std::max(options_.min_radius_mm, options_.slenderness ? length / *options_.slenderness : 0.0);
      for (; first < struts.size(); ++first) struts[first].radius_mm = radius;
    };
    for (const int next : s.joints) {
      if (carries) struts.push_back({upper, next, s.kind, 0.0});
      const bool arrives = carries || loaded[next];
      const bool held = arrives && ends_in_wall(s, next);
      if (carries && held) size_pieces(next);
      if (held) plan_.nodes[next - frame_.nodes_mm.size()].on = On::kSkin;
      if (!carries && arrives) top = next;
      carries = arrives && !held;
      upper = next;
    }
    if (carries) {
      size_pieces(s.lower);
      loaded[s.lower] = true;
    }
    return struts;
  }

  // Later supports end on earlier ones, never the other way round.
  Result<SupportPlan> finish() {
    std::vector<bool> loaded(points_.size(), false);
    std::vector<std::vector<SupportStrut>> struts(supports_.size());
    for (std::size_t s = supports_.size(); s-- > 0;) struts[s] = struts_of(supports_[s], loaded);
    for (const auto& list : struts) plan_.struts.insert(plan_.struts.end(), list.begin(), list.end());
    drop_unused_nodes();
    return std::move(plan_);
  }

  // Feet and joints that no strut has.
  void drop_unused_nodes() {
    const int own = static_cast<int>(frame_.nodes_mm.size());
    std::vector<bool> used(points_.size(), false);
    for (const SupportStrut& strut : plan_.struts) used[strut.upper] = used[strut.lower] = true;
    std::vector<int> renumbered(points_.size());
    std::iota(renumbered.begin(), renumbered.begin() + own, 0);
    std::vector<SupportNode> kept;
    for (int i = own; i < static_cast<int>(points_.size()); ++i) {
      if (!used[i] && i >= static_cast<int>(first_of_supports_)) continue;
      renumbered[i] = own + static_cast<int>(kept.size());
      kept.push_back(plan_.nodes[i - own]);
    }
    plan_.nodes = std::move(kept);
    for (SupportStrut& strut : plan_.struts) {
      strut.upper = renumbered[strut.upper];
      strut.lower = renumbered[strut.lower];
    }
  }

  const Frame& frame_;
  const PrintableLength& curve_;
  const PrintedBody& body_;
  const SupportOptions& options_;
  std::vector<Vector3d> points_;  // of the frame, then of the plan
  SupportPlan plan_;
  std::vector<Support> supports_;
  double flattest_;  // flattest angle from the vertical at which a support leads down, radians
  std::size_t first_of_supports_ = 0;   // index of the first foot or joint
  std::vector<SupportKind> foot_kind_;  // of each of those
};

}  // namespace

Result<SupportPlan> plan_supports(const Frame& frame, const PrintableLength& curve, const PrintedBody& body,
                                  const SupportOptions& options, const RunContext& context) {
  return Planner(frame, curve, body, options).run(context);
}

std::vector<std::vector<int>> divided_struts(const Frame& frame, const SupportPlan& plan) {
  std::vector<std::vector<int>> nodes;
  for (const Strut& strut : frame.struts) nodes.push_back({strut.a});
  const int own = static_cast<int>(frame.nodes_mm.size());
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)  // in order along each strut
    if (plan.nodes[i].strut >= 0) nodes[plan.nodes[i].strut].push_back(own + static_cast<int>(i));
  for (std::size_t j = 0; j < frame.struts.size(); ++j) nodes[j].push_back(frame.struts[j].b);
  return nodes;
}

}  // namespace skinframe
