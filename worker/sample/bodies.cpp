// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sample/bodies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace skinframe {
namespace {

// The paper's figure 7: base, pillar, arm, ball, one size of everything but the base. The pillar is fat, so
// that it weighs the solid down (volume / area = r / 2, the ball's is r / 3) but hardly its skin: as a solid
// the body stands on the small base too, as a bare skin it tips over the ball's side, and struts have to mend
// that.
Implicit hanging_ball(double base_radius) {
  constexpr double kPillarRadius = 27, kArmRadius = 9, kBallRadius = 30, kReach = 121, kTop = 200;
  const double arm_z = kTop - kPillarRadius;
  Implicit body = upright_cylinder({0, 0}, base_radius, -10, 12, 2);
  body = join(std::move(body), capsule({0, 0, 5}, {0, 0, arm_z}, kPillarRadius), 3);
  body = join(std::move(body), capsule({0, 0, arm_z}, {kReach, 0, arm_z}, kArmRadius), 5);
  body = join(std::move(body), sphere({kReach, 0, arm_z - kBallRadius}, kBallRadius), 5);
  return stand_on_plate(std::move(body));
}

Implicit ring() {
  Implicit body = upright_torus({0, 0, 104}, 74, 22);
  return stand_on_plate(join(std::move(body), rounded_box({-58, -38, -20}, {58, 38, 16}, 5), 12));
}

Implicit stool() {
  Implicit body = upright_cylinder({0, 0}, 74, 178, 200, 8);
  for (int leg = 0; leg < 4; ++leg) {
    const double sx = leg == 0 || leg == 3 ? 1 : -1, sy = leg < 2 ? 1 : -1;
    body = join(std::move(body), capsule({44 * sx, 44 * sy, 186}, {66 * sx, 66 * sy, -12}, 7), 6);
    const double next_sx = -sy * 1.0, next_sy = sx * 1.0;  // a quarter turn on
    const double rung = 59.5;                              // where the leg's axis is at the rung's height
    body = join(std::move(body),
                capsule({rung * sx, rung * sy, 52}, {rung * next_sx, rung * next_sy, 52}, 5.5), 4);
  }
  return stand_on_plate(std::move(body));
}

// A vase's outline, its wall covered with a diamond pattern 1.5 mm high that fades out at foot and lip.
Implicit relief() {
  return stand_on_plate([](const Point& p) {
    constexpr double kHeight = 200, kReliefHeight = 1.5, kColumns = 14, kPitch = 26;
    constexpr double kTurn = 2 * std::numbers::pi;
    const double z = std::clamp(p.z(), 0.0, kHeight);
    const double outline = 50 + 17 * std::sin(kTurn * (z / kHeight * 0.75 - 0.03));
    const double slope = 17 * kTurn * 0.75 / kHeight * std::cos(kTurn * (z / kHeight * 0.75 - 0.03));
    const double around = std::atan2(p.y(), p.x());
    const double fade = std::clamp(std::min(z - 12, kHeight - 14 - z) / 14, 0.0, 1.0);
    const double pattern = std::cos(kColumns * around) * std::cos(kTurn * z / kPitch);
    const double out =
        (p.head<2>().norm() - outline - fade * kReliefHeight * pattern) / std::hypot(1.0, slope);
    const double above = p.z() - kHeight;
    constexpr double kLip = 6;  // rounding of the upper edge
    const double a = out + kLip, b = above + kLip;
    return std::min(std::max(a, b), 0.0) + std::hypot(std::max(a, 0.0), std::max(b, 0.0)) - kLip;
  });
}

Implicit egg() { return stand_on_plate(ellipsoid({0, 0, 92}, {70, 70, 108})); }

Implicit bracket() {
  Implicit body = rounded_box({-65, -40, -20}, {65, 40, 16}, 3);
  body = join(std::move(body), rounded_box({-65, -40, -20}, {-47, 40, 200}, 3), 6);
  // The gusset: a slab under a slanting plane from the upright's upper part to the foot's end.
  const Implicit slab = rounded_box({-60, -9, 0}, {60, 9, 170}, 3);
  const Point slant = Point(150, 0, 100).normalized();
  const Implicit gusset = [=](const Point& p) { return std::max(slab(p), slant.dot(p - Point(50, 0, 16))); };
  body = join(std::move(body), gusset, 5);
  body = cut(std::move(body), [](const Point& p) { return std::hypot(p.y(), p.z() - 178) - 11; });
  for (const double y : {-25.0, 25.0}) {
    body = cut(std::move(body), [y](const Point& p) { return std::hypot(p.x() - 40, p.y() - y) - 7; });
  }
  return stand_on_plate(std::move(body));
}

}  // namespace

std::vector<Body> sample_bodies() {
  std::vector<Body> bodies;
  bodies.push_back(
      {{"hanging-ball", "the paper's figure 7: a ball hung on an arm from a pillar, on the wide base"},
       hanging_ball(44),
       {{-50, -50, -4}, {158, 50, 206}},
       2.0});
  bodies.push_back(
      {{"hanging-ball-small-base", "the same ball, arm and pillar on a base its bare skin tips over"},
       hanging_ball(30.5),
       {{-50, -50, -4}, {158, 50, 206}},
       2.0});
  bodies.push_back({{"ring", "an upright ring on a flat foot: one hole through it"},
                    ring(),
                    {{-102, -44, -4}, {102, 44, 206}},
                    2.0});
  bodies.push_back({{"stool", "a seat on four thin splayed legs with rungs between them"},
                    stool(),
                    {{-84, -84, -4}, {84, 84, 206}},
                    2.0});
  bodies.push_back({{"relief", "a solid vase covered with a fine raised pattern"},
                    relief(),
                    {{-80, -80, -4}, {80, 80, 206}},
                    2.1});
  bodies.push_back({{"egg", "a plain egg with a flat foot"}, egg(), {{-76, -76, -4}, {76, 76, 206}}, 2.2});
  bodies.push_back({{"bracket", "an angle bracket with a gusset and three bolt holes"},
                    bracket(),
                    {{-70, -46, -4}, {70, 46, 206}},
                    1.8});
  return bodies;
}

}  // namespace skinframe
