// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/picture/bodies.h"

#include <fmt/format.h>

#include <algorithm>

#include "worker/picture/sheet.h"
#include "worker/raster/colour_map.h"
#include "worker/raster/scene.h"

namespace skinframe::picture {
namespace {

constexpr Colour kSupport{222, 62, 80};  // no colour of the map is like it
constexpr Colour kOutside{206, 210, 216}, kInside{150, 168, 190}, kCut{226, 88, 62};
constexpr double kAsideDeg = 28, kAboveDeg = 20;

// Before the longer of the two horizontal sides of what is drawn.
struct View {
  Eigen::Matrix3d axes;
  CutPlane middle;  // parallel to that side, its normal towards the viewer
};

View view_of(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::Vector3d low = points_mm.front(), high = low;
  for (const Eigen::Vector3d& p : points_mm) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector3d middle = (low + high) / 2;
  if (high.y() - low.y() > high.x() - low.x())
    return {view_axes(90 - kAsideDeg, kAboveDeg), {Eigen::Vector3d::UnitX(), middle.x()}};
  return {view_axes(kAsideDeg, kAboveDeg), {-Eigen::Vector3d::UnitY(), -middle.y()}};
}

Camera camera_in(const Place& place, const View& view, const std::vector<Eigen::Vector3d>& points_mm,
                 double margin_mm) {
  return fit_camera(view.axes, points_mm, margin_mm, place.width, place.height);
}

// What is left of the mesh has to fit: its vertices, and where its edges meet the cut.
std::vector<Eigen::Vector3d> left_by(const TriangleMesh& mesh, const CutPlane& cut) {
  const auto beyond = [&](int v) { return cut.normal.dot(mesh.vertices[v]) - cut.offset_mm; };
  std::vector<Eigen::Vector3d> left;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const double from = beyond(t[k]), to = beyond(t[(k + 1) % 3]);
      const Eigen::Vector3d &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
      if (from <= 0) left.push_back(a);
      if ((from < 0 && to > 0) || (from > 0 && to < 0)) left.emplace_back(a + (b - a) * (from / (from - to)));
    }
  return left;
}

}  // namespace

Image frame_picture(const DrawnFrame& frame, const std::string& title, int side_px) {
  double low = frame.struts.front().radius_mm, high = low, thickest = low;
  std::vector<Eigen::Vector3d> ends;
  for (const DrawnStrut& strut : frame.struts) {
    low = std::min(low, strut.radius_mm);
    high = std::max(high, strut.radius_mm);
  }
  thickest = high;
  for (const auto* struts : {&frame.struts, &frame.supports})
    for (const DrawnStrut& strut : *struts) {
      ends.insert(ends.end(), {strut.a_mm, strut.b_mm});
      thickest = std::max(thickest, strut.radius_mm);
    }
  std::string below = fmt::format("frame, {} struts coloured by radius", frame.struts.size());
  if (!frame.supports.empty()) below += fmt::format("; {} support struts", frame.supports.size());
  Sheet sheet(side_px, side_px, title, below, true);
  const Place place = sheet.body();
  Scene scene(place.width, place.height, camera_in(place, view_of(ends), ends, thickest));
  for (const DrawnStrut& strut : frame.struts)
    scene.add_capsule(strut.a_mm, strut.b_mm, strut.radius_mm,
                      viridis(high > low ? (strut.radius_mm - low) / (high - low) : 0.0));
  for (const DrawnStrut& strut : frame.supports)
    scene.add_capsule(strut.a_mm, strut.b_mm, strut.radius_mm, kSupport);
  // Colours are read here: thin rods, dark enough by themselves, are darkened little.
  sheet.image().paste(scene.picture(kWhite, 0.4), place.x, place.y);
  sheet.colour_bar(low, high, "radius mm");
  if (!frame.supports.empty()) sheet.legend(kSupport, "supports");
  return std::move(sheet.image());
}

Image cutaway_picture(const TriangleMesh& mesh, const std::string& title, int side_px) {
  const Eigen::Vector3d size = bounding_box(mesh).extent();
  Sheet sheet(
      side_px, side_px, title,
      fmt::format("cut through the middle of {:.0f} x {:.0f} x {:.0f} mm", size.x(), size.y(), size.z()),
      false);
  const Place place = sheet.body();
  const View view = view_of(mesh.vertices);
  Scene scene(place.width, place.height,
              camera_in(place, view, left_by(mesh, view.middle), 0.01 * size.norm()), view.middle);
  scene.add_mesh(mesh, kOutside, kInside);
  scene.close_cut(kCut);
  sheet.image().paste(scene.picture(kWhite), place.x, place.y);
  sheet.legend(kCut, "material in the plane of the cut");
  return std::move(sheet.image());
}

Image coloured_picture(const TriangleMesh& mesh, const std::vector<Colour>& vertex_colours,
                       const std::string& title, const std::string& below, int side_px) {
  Sheet sheet(side_px, side_px, title, below, false);
  const Place place = sheet.body();
  Scene scene(
      place.width, place.height,
      camera_in(place, view_of(mesh.vertices), mesh.vertices, 0.01 * bounding_box(mesh).extent().norm()));
  scene.add_mesh(mesh, vertex_colours);
  sheet.image().paste(scene.picture(kWhite), place.x, place.y);
  return std::move(sheet.image());
}

}  // namespace skinframe::picture
