// SPDX-License-Identifier: GPL-3.0-or-later
// The claim about --orient best: a body whose estimate is known by heart, real ones as the pipeline ranks
// them, and lies.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <numbers>

#include "worker/check/claims.h"
#include "worker/profile/printable_length.h"
#include "worker/sample/make_sample.h"
#include "worker/support/orient_body.h"

namespace skinframe::check {
namespace {

ExportedPrinter extrusion_printer() {
  ExportedPrinter result;
  result.eta_mm = 0.4;
  result.skin_thickness_mm = 0.8;
  result.supports.emplace();
  result.supports->self_supporting_angle_deg = 45;
  result.supports->printable_length = {{45, std::numeric_limits<double>::infinity()}, {90, 10}};
  return result;
}

void add_box(TriangleMesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(),
                               k & 4 ? high.z() : low.z());
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                   std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.triangles.push_back({first + a, first + c, first + d});
  }
}

bool holds(const ExportedOrientation& orientation, const ExportedPrinter& result, const TriangleMesh& mesh,
           std::string* told = nullptr) {
  Verdict verdict;
  claim_orientation(orientation, result, mesh, &verdict);
  if (told != nullptr) *told = verdict.claims.front().measured;
  return verdict.claims.front().holds;
}

const Eigen::Matrix3d kUpsideDown =
    Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();

// A table upside down: a plate of 60 x 60 x 10 mm on the base plane, on it a leg of 20 x 20 x 40 mm. A piece
// of flat skin of area a at height l needs a (0.4 / 5)^2 l.
class OrientationClaim : public testing::Test {
 protected:
  OrientationClaim() {
    add_box(table_, {-30, -30, 0}, {30, 30, 10});
    add_box(table_, {-10, -10, 10}, {10, 10, 50});
  }
  static ExportedAttitude chosen() { return {kUpsideDown, kRoofs + 400 * kEach * 10, 30}; }
  static ExportedAttitude upright() { return {Eigen::Matrix3d::Identity(), kRoofs + 3600 * kEach * 40, 10}; }
  static bool holds_for(const ExportedAttitude& chosen, const ExportedAttitude& runner_up,
                        const TriangleMesh& mesh, std::string* told = nullptr) {
    ExportedOrientation orientation;
    orientation.chosen = chosen;
    orientation.runner_up.emplace(runner_up);
    return holds(orientation, extrusion_printer(), mesh, told);
  }
  static constexpr double kEach = 0.4 * 0.4 / 25;
  static constexpr double kRoofs = 3600 * kEach * (10 - 1.6) + 400 * kEach * (40 - 1.6);
  TriangleMesh table_;
};

TEST_F(OrientationClaim, TheEstimateIsThatOfTheFormula) {
  std::string told;
  EXPECT_TRUE(holds_for(chosen(), upright(), table_, &told)) << told;
}

TEST_F(OrientationClaim, FalseFiguresAreSeen) {
  ExportedAttitude lie = chosen();
  lie.support_estimate_mm3 *= 0.7;
  EXPECT_FALSE(holds_for(lie, upright(), table_));
  lie = chosen();
  lie.standing_margin_mm += 1;
  EXPECT_FALSE(holds_for(lie, upright(), table_));
  lie = upright();
  lie.support_estimate_mm3 *= 1.3;
  EXPECT_FALSE(holds_for(chosen(), lie, table_));
}

TEST_F(OrientationClaim, AChoiceThatIsWorseThanTheOtherIsSeen) {
  TriangleMesh turned = table_;
  for (auto& v : turned.vertices) v = kUpsideDown * v;
  EXPECT_FALSE(holds_for(upright(), chosen(), turned));
}

TEST_F(OrientationClaim, AnAttitudeThatTheBodyIsNotInIsSeen) {
  ExportedAttitude lie = chosen();
  lie.rotation.setIdentity();
  EXPECT_FALSE(holds_for(lie, upright(), table_)) << "the runner-up would be this one again";
  lie = chosen();
  lie.rotation.row(0) *= -1;
  EXPECT_FALSE(holds_for(lie, upright(), table_)) << "a mirror image";
}

TEST(OrientationOfBodies, IsRankedAsTheCheckWouldRankIt) {
  for (const char* sample : {"bracket", "hanging-ball"}) {
    RunContext context;
    auto mesh = make_sample(sample, context);
    ASSERT_TRUE(mesh.ok());
    auto curve = PrintableLength::make({{45, std::nullopt}, {90, 10.0}}, false, "made up");
    ASSERT_TRUE(curve.ok());
    const auto ranked = rank_attitudes(*mesh, *curve, OrientOptions{});
    ASSERT_GE(ranked.size(), 2u);
    const auto attitude = [](const Attitude& a) {
      return ExportedAttitude{a.rotation, a.support_mm3, a.margin_mm};
    };
    TriangleMesh turned = *mesh;
    for (auto& v : turned.vertices) v = ranked[0].rotation * v;
    std::string told;
    ExportedOrientation orientation;
    orientation.chosen = attitude(ranked[0]);
    orientation.runner_up.emplace(attitude(ranked[1]));
    EXPECT_TRUE(holds(orientation, extrusion_printer(), turned, &told)) << sample << ": " << told;
  }
}

}  // namespace
}  // namespace skinframe::check
