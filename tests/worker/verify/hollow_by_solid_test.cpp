// SPDX-License-Identifier: GPL-3.0-or-later
// The uniform hollow as shell against the same hollow as quadratic tetrahedra, side load and pinch, on a
// waisted vase and on a jar. Held is the same on either side: all of the wall, inside and outside, below a
// plane well above the foot. (Held at the contact alone, the shell turns about the rim of its foot, where a
// wall of some thickness is clamped by its width: supports would be compared, not walls.)
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>

#include "tests/worker/fixture/geodesic_sphere.h"
#include "tests/worker/fixture/skin_of.h"
#include "worker/frame/on_m1.h"
#include "worker/skin/triangle_tree.h"
#include "worker/stress/quadratic_solid.h"
#include "worker/structure/solve_structure.h"
#include "worker/verify/hollow.h"
#include "worker/verify/pinch.h"
#include "worker/verify/shell_models.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

constexpr double kWallMm = 2, kAgree = 0.05, kPatchMm = 6;
const Vector3d kPushN(20, 0, 0);

struct Body {
  const char* name;
  double height_mm;
  std::function<double(double)> radius_mm;  // at a height of -1 .. 1
};

void PrintTo(const Body& body, std::ostream* out) { *out << body.name; }

const Body kBodies[] = {
    {"vase", 84, [](double z) { return 17.0 + 9.0 * z * z; }},
    {"jar", 80, [](double z) { return 22.0 * std::pow(std::max(1 - z * z, 1e-3), -0.35); }},
};

TriangleMesh shape(const Body& body, int frequency) {
  Frame frame;
  test::add_geodesic_triangles(frequency, frame);
  TriangleMesh mesh{frame.nodes_mm, frame.skin_triangles};
  for (Vector3d& p : mesh.vertices) {
    const double wide = body.radius_mm(p.z());
    p = {p.x() * wide, p.y() * wide, (1 + p.z()) * body.height_mm / 2};
  }
  return mesh;
}

// The wall between the surface and the same moved inward along its normals: each triangle a prism of three
// tetrahedra, cut along the diagonals from the lower number above to the higher one below.
TetMesh wall_of(const TriangleMesh& outer, double wall_mm) {
  const int n = static_cast<int>(outer.vertices.size());
  std::vector<Vector3d> normals(outer.vertices.size(), Vector3d::Zero());
  for (const auto& t : outer.triangles) {
    const Vector3d &a = outer.vertices[t[0]], &b = outer.vertices[t[1]], &c = outer.vertices[t[2]];
    for (const int v : t) normals[v] += (b - a).cross(c - a);
  }
  TetMesh wall{outer.vertices, {}};
  for (int v = 0; v < n; ++v)
    wall.vertices_mm.push_back(outer.vertices[v] - wall_mm * normals[v].normalized());
  for (std::array<int, 3> t : outer.triangles) {
    std::sort(t.begin(), t.end());
    for (std::array<int, 4> tet :
         {std::array{t[0], t[1], t[2], n + t[2]}, std::array{t[0], t[1], n + t[1], n + t[2]},
          std::array{t[0], n + t[0], n + t[1], n + t[2]}}) {
      if (tet_volume_mm3(wall, tet) < 0) std::swap(tet[0], tet[1]);
      wall.tets.push_back(tet);
    }
  }
  return wall;
}

// Equal shares of area on the nodes about a point.
Eigen::VectorXd patch_load(const Structure& s, const Vector3d& at, const Vector3d& force) {
  Eigen::VectorXd share = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(s.nodes_mm.size()));
  double area = 0;
  for (std::size_t i = 0; i < s.shells.size(); ++i) {
    const ShellTriangle shell = s.shell(i);
    if (((shell.corner_mm[0] + shell.corner_mm[1] + shell.corner_mm[2]) / 3 - at).norm() > kPatchMm) continue;
    area += shell_area_mm2(shell);
    for (const int v : s.shells[i].nodes) share.segment<3>(6 * v) += force * shell_area_mm2(shell) / 3;
  }
  return share / area;
}

class Hollow : public testing::TestWithParam<Body> {};

TEST_P(Hollow, OfShellsGivesWayAsThatOfQuadraticTetrahedra) {
  const TriangleMesh body = shape(GetParam(), 32);
  const Skin skin = test::skin_of(body);
  FrameProblem problem;
  problem.material = {"pa", 1586, 1387, 43, 48, 60, 1.15};
  Frame& frame = problem.frame;
  const TriangleMesh coarse = shape(GetParam(), 6);
  for (const Vector3d& p : coarse.vertices) frame.nodes_mm.push_back(onto_m1(p, skin));
  frame.skin_triangles = coarse.triangles;
  frame.skin_node_count = static_cast<int>(coarse.vertices.size());
  problem.fixed.assign(frame.nodes_mm.size(), {false, false, false});
  const FineSkin fine = refine_skin(frame, skin, 2);
  const TriangleTree tree(body);
  Structure shell = hollow_structure(problem, skin, fine, local_walls_mm(fine, skin, tree, kWallMm));
  shell.weight_density_n_mm3 = 0;
  const double held_below_mm = 0.2 * GetParam().height_mm;
  for (std::size_t i = 0; i < shell.nodes_mm.size(); ++i)
    if (shell.nodes_mm[i].z() <= held_below_mm) shell.held[i] = kClamped;

  const Vector3d top(0, 0, GetParam().height_mm);
  const auto sites = spread_pinches(fine, skin, tree, 8);
  ASSERT_EQ(sites.size(), 8u);
  const NodalColumns pinches = pinch_columns(shell, fine, sites);
  NodalColumns loads(pinches.rows(), pinches.cols() + 1);
  loads.col(0) = patch_load(shell, top - Vector3d(0, 0, kWallMm / 2), kPushN);
  loads.rightCols(pinches.cols()) = pinches;
  RunContext context;
  const auto solver = StructureSolver::factorise(shell, context);
  ASSERT_TRUE(solver.ok()) << solver.error().message;
  const NodalColumns d = solver->solve(loads);

  const TetMesh tets = wall_of(shape(GetParam(), 16), kWallMm);
  EXPECT_NEAR(volume_mm3(tets) / structure_volume_mm3(shell), 1, 0.03);
  std::vector<SolidCase> cases{{"side", false, {{"side", top, kPushN, kPatchMm}}}};
  for (const PinchSite& site : sites) {
    const Vector3d near = fine.frame.nodes_mm[site.node], far = fine.frame.nodes_mm[site.opposite];
    const Vector3d push = kPinchForceN * (far - near).normalized();
    cases.push_back(
        {"pinch", false, {{"pinch", near, push, kPinchRadiusMm}, {"pinch", far, -push, kPinchRadiusMm}}});
  }
  const auto solid = solve_quadratic_solid(
      tets, shell.material, 0, [&](const Vector3d& p) { return p.z() <= held_below_mm; }, cases, context);
  ASSERT_TRUE(solid.ok()) << solid.error().message;

  const double side = loads.col(0).dot(d.col(0));
  RecordProperty("side", std::to_string(side / (*solid)[0].external_work_n_mm));
  EXPECT_NEAR(side / (*solid)[0].external_work_n_mm, 1, kAgree);
  double shell_mean = 0, solid_mean = 0, shell_worst = 0, solid_worst = 0;
  for (std::size_t c = 1; c < cases.size(); ++c) {
    const double by_shell = loads.col(c).dot(d.col(c)), by_solid = (*solid)[c].external_work_n_mm;
    shell_mean += by_shell;
    solid_mean += by_solid;
    shell_worst = std::max(shell_worst, by_shell);
    solid_worst = std::max(solid_worst, by_solid);
  }
  RecordProperty("pinch_mean", std::to_string(shell_mean / solid_mean));
  RecordProperty("pinch_worst", std::to_string(shell_worst / solid_worst));
  EXPECT_NEAR(shell_mean / solid_mean, 1, kAgree);
  EXPECT_NEAR(shell_worst / solid_worst, 1, kAgree);
}

INSTANTIATE_TEST_SUITE_P(Bodies, Hollow, testing::ValuesIn(kBodies),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace skinframe
