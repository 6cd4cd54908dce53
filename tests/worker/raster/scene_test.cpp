// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies seen by the scene, against the areas that geometry gives.
#include "worker/raster/scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/worker/fixture/geodesic_sphere.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr int kSide = 300;
constexpr double kMm = 60;  // of the object's extent, seen from anywhere
constexpr Colour kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255};

Camera camera_from(double azimuth_deg, double elevation_deg) {
  Camera camera;
  camera.axes = view_axes(azimuth_deg, elevation_deg);
  camera.px_per_mm = kSide / kMm;
  camera.shift_px = {kSide / 2.0, kSide / 2.0};
  return camera;
}

TriangleMesh sphere(double radius_mm, bool outward = true) {
  Frame frame;
  test::add_geodesic_triangles(24, frame);
  TriangleMesh mesh{frame.nodes_mm, frame.skin_triangles};
  for (Vector3d& v : mesh.vertices) v *= radius_mm;
  if (!outward)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

void append(TriangleMesh& to, const TriangleMesh& from) {
  const int shift = static_cast<int>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (const auto& [a, b, c] : from.triangles) to.triangles.push_back({a + shift, b + shift, c + shift});
}

double covered_mm2(const Scene& scene) { return scene.covered_share() * kMm * kMm; }

// Share of the pixels whose strongest channel is `channel`, with nothing else in them.
double share_of(const Image& image, int channel) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const Colour c = image.at(x, y);
      count += c[channel] > 0 && c[(channel + 1) % 3] == 0 && c[(channel + 2) % 3] == 0;
    }
  return double(count) / (kSide * kSide);
}

constexpr Colour kBlack{0, 0, 0};

TEST(Scene, ASpheresSilhouetteHasItsArea) {
  Scene round(kSide, kSide, camera_from(30, 20));
  round.add_capsule(Vector3d(1, 2, 3), Vector3d(1, 2, 3), 20, kRed);
  EXPECT_NEAR(covered_mm2(round), pi * 400, 2e-3 * pi * 400);
  Scene mesh(kSide, kSide, camera_from(30, 20));
  mesh.add_mesh(sphere(20), kRed, kGreen);
  EXPECT_NEAR(covered_mm2(mesh), pi * 400, 6e-3 * pi * 400);  // inscribed
}

TEST(Scene, AStrutsSilhouetteIsARectangleAndTwoHalfDiscs) {
  for (const double azimuth : {0.0, 35.0, 90.0, 200.0})
    for (const double elevation : {-60.0, 0.0, 25.0, 90.0}) {
      const Camera camera = camera_from(azimuth, elevation);
      const Vector3d a(-9, 4, -7), b(8, -6, 10);
      Scene scene(kSide, kSide, camera);
      scene.add_capsule(a, b, 3, kRed);
      const double seen = (camera.axes * (b - a)).head<2>().norm();
      const double area = 2 * 3 * seen + pi * 9;
      EXPECT_NEAR(covered_mm2(scene), area, 0.01 * area) << azimuth << " " << elevation;
    }
}

TEST(Scene, NearerStrutsHideFurtherOnesInEitherOrder) {
  const Camera camera = camera_from(0, 0);  // from -y
  const auto near = [](Scene& s) { s.add_capsule({-20, -10, 0}, {20, -10, 0}, 4, kRed); };
  const auto far = [](Scene& s) { s.add_capsule({0, 10, -20}, {0, 10, 20}, 4, kBlue); };
  Scene one(kSide, kSide, camera), other(kSide, kSide, camera);
  near(one), far(one);
  far(other), near(other);
  const Image image = one.picture(kWhite);
  EXPECT_EQ(image, other.picture(kWhite));
  const Colour middle = image.at(kSide / 2, kSide / 2);
  EXPECT_GT(middle[0], 60);
  EXPECT_EQ(middle[2], 0);
  EXPECT_GT(image.at(kSide / 2, kSide / 2 + 60)[2], 60);  // below the crossing the blue one shows
}

TEST(Scene, AMeshAndAStrutOfTheSameShapeHideEachOtherByTheirDepths) {
  Scene scene(kSide, kSide, camera_from(0, 0));
  scene.add_mesh(sphere(15), kRed, kGreen);
  scene.add_capsule({0, 0, 0}, {0, 0, 0}, 14.5, kBlue);
  EXPECT_EQ(share_of(scene.picture(kBlack), 2), 0);
  scene.add_capsule({0, 0, 0}, {0, 0, 0}, 16, kBlue);
  EXPECT_EQ(share_of(scene.picture(kBlack), 0), 0);
}

TEST(Scene, AClosedMeshHasNeitherCracksNorDoubledSamples) {
  // A cut that takes nothing away: every ray leaves the solid as often as it enters, at each sample.
  for (const double azimuth : {0.0, 17.0, 45.0, 90.0}) {
    const Camera camera = camera_from(azimuth, 12);
    Scene scene(kSide, kSide, camera, CutPlane{camera.axes.row(2), 100});
    scene.add_mesh(sphere(25), kRed, kGreen);
    scene.close_cut(kBlue);
    const Image image = scene.picture(kBlack);
    EXPECT_EQ(share_of(image, 2), 0) << azimuth;
    EXPECT_EQ(share_of(image, 1), 0) << azimuth;  // nor is the inside seen through a crack
  }
}

TEST(Scene, CutFacesAreFilledWhereThereIsMaterial) {
  TriangleMesh shell = sphere(25);
  append(shell, sphere(20, false));
  const Camera camera = camera_from(0, 0);
  Scene scene(kSide, kSide, camera, CutPlane{-Vector3d::UnitY(), 0});
  scene.add_mesh(shell, kRed, kGreen);
  scene.close_cut(kBlue);
  const Image image = scene.picture(kBlack);
  const double ring = pi * (625 - 400) / (kMm * kMm), hollow = pi * 400 / (kMm * kMm);
  EXPECT_NEAR(share_of(image, 2), ring, 0.04 * ring);
  EXPECT_NEAR(share_of(image, 0), hollow, 0.04 * hollow);  // the far wall's inside: a surface facing us
  EXPECT_EQ(share_of(image, 1), 0);
}

TEST(Scene, ASlantedCutOfASolidBallIsAFilledDisc) {
  const Camera camera = camera_from(25, 18);
  Scene scene(kSide, kSide, camera, CutPlane{-Vector3d::UnitY(), 7});
  scene.add_mesh(sphere(25), kRed, kGreen);
  scene.close_cut(kBlue);
  const double tilt = camera.axes.row(2).dot(-Vector3d::UnitY());
  const double disc = pi * (625 - 49) * tilt / (kMm * kMm);
  EXPECT_NEAR(share_of(scene.picture(kBlack), 2), disc, 0.04 * disc);
}

TEST(Scene, ColoursOfVerticesBlendBetweenThem) {
  const TriangleMesh wall{{{-20, 0, -20}, {20, 0, -20}, {20, 0, 20}, {-20, 0, 20}},
                          {{{0, 1, 2}}, {{0, 2, 3}}}};
  Scene scene(kSide, kSide, camera_from(0, 0));
  scene.add_mesh(wall, {kRed, kBlue, kBlue, kRed});
  const Image image = scene.picture(kWhite);
  const auto share = [&](double mm) {
    const Colour c = image.at(static_cast<int>(kSide / 2.0 + mm * kSide / kMm), kSide / 2);
    return double(c[2]) / (c[0] + c[2]);
  };
  EXPECT_NEAR(share(0), 0.5, 0.02);
  EXPECT_NEAR(share(-10), 0.25, 0.02);
  EXPECT_NEAR(share(15), 0.875, 0.02);
}

TEST(Scene, FarCornersAndEmptyBodiesAreNoHarm) {
  Scene scene(40, 40, camera_from(0, 0));
  scene.add_mesh({{{-1e9, 0, -1e9}, {1e9, 0, -1e9}, {0, 0, 1e9}}, {{{0, 1, 2}}}}, kRed, kGreen);
  EXPECT_EQ(scene.covered_share(), 1);
  Scene empty(40, 40, camera_from(0, 0));
  empty.add_mesh({}, kRed, kGreen);
  empty.add_mesh({{{0, 0, 0}}, {{{0, 0, 0}}}}, kRed, kGreen);
  empty.add_capsule({0, 0, 0}, {1, 1, 1}, 0, kRed);
  empty.close_cut(kBlue);
  EXPECT_EQ(empty.covered_share(), 0);
}

TEST(FitCamera, EveryPointLiesInTheViewAndTwoSidesTouch) {
  const std::vector<Vector3d> points = {{-40, 3, 0}, {25, -60, 8}, {7, 7, 90}, {0, 0, -5}};
  const Camera camera = fit_camera(view_axes(33, 21), points, 2, 320, 200);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (const Vector3d& p : points) {
    const Vector3d seen = camera.project(p);
    left = std::min(left, seen.x()), right = std::max(right, seen.x());
    top = std::min(top, seen.y()), bottom = std::max(bottom, seen.y());
  }
  const double margin = 2 * camera.px_per_mm;
  EXPECT_GE(left - margin, -1e-9);
  EXPECT_LE(right + margin, 320 + 1e-9);
  EXPECT_NEAR(top - margin, 0, 1e-9);
  EXPECT_NEAR(bottom + margin, 200, 1e-9);
  EXPECT_NEAR((camera.axes * camera.axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
  EXPECT_NEAR(camera.axes.determinant(), 1, 1e-12);
}

}  // namespace
}  // namespace skinframe
