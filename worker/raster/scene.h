// SPDX-License-Identifier: GPL-3.0-or-later
// Lit bodies with depth, in software: no display, no driver, the same picture everywhere.
//
// Guarantees:
//  1. What is nearer hides what is further.
//  2. Every sample of a picture belongs to exactly one of two triangles that share an edge (the top-left rule
//     on corners rounded to 1/256 sample), so a closed mesh has neither cracks nor doubled samples.
//  3. A closed mesh that is cut open shows its material filled: a point of the cut is material where the
//     surfaces behind it, counted out minus in along the view ray, say so. No polygon is clipped.
//  4. Same calls, same picture.
// Two by two samples make a pixel. Corners between surfaces are darkened as in Luft, Colditz, Deussen, "Image
// enhancement by unsharp masking the depth buffer", 2006.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/raster/camera.h"
#include "worker/raster/image.h"

namespace skinframe {

// What lies at normal . p > offset_mm is taken away. The normal has length 1 and faces the viewer.
struct CutPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double offset_mm = 0;
};

class Scene {
 public:
  // Memory: 32 bytes a pixel, 40 with a cut. Sides from 1 to kMaxSidePx / 2.
  Scene(int width_px, int height_px, const Camera& camera, std::optional<CutPlane> cut = std::nullopt);

  // `front` where the triangle's outside is seen, `back` where its inside is.
  void add_mesh(const TriangleMesh& mesh, Colour front, Colour back);
  // A colour a vertex.
  void add_mesh(const TriangleMesh& mesh, const std::vector<Colour>& vertex_colours);
  // A strut as it is printed: round, with round ends. Nothing where the radius is not positive.
  void add_capsule(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm, double radius_mm, Colour colour);
  // Fills the material in the plane of the cut, in this very colour without light; once, after the last mesh.
  // Without a cut nothing happens.
  void close_cut(Colour colour);

  // Share of the picture that anything covers.
  double covered_share() const;
  // darkest, in [0, 1]: of the deepest corners between surfaces.
  Image picture(Colour background, double darkest = 0.75) const;

 private:
  struct Corner;
  void add(const TriangleMesh& mesh, const std::vector<Colour>* vertex_colours, Colour front, Colour back);
  void add_triangle(const Corner (&corners)[3], Colour front, Colour back, bool by_corner);
  void put_lit(std::size_t sample, double depth_mm, double light, const Colour& colour);
  void put(std::size_t sample, double depth_mm, const Eigen::Vector3d& normal, const Colour& colour);
  double cut_depth_mm(int x, int y) const;  // of the plane on this sample's ray
  double darkness(int x, int y) const;

  int width_, height_;  // in samples
  Camera camera_;
  std::optional<CutPlane> cut_;
  Eigen::Vector3d cut_seen_ = Eigen::Vector3d::Zero();  // its normal in the view's axes
  std::vector<float> depth_mm_;
  std::vector<std::array<std::uint8_t, 4>> lit_;
  std::vector<std::int16_t> exits_;  // surfaces behind the cut: out minus in
};

}  // namespace skinframe
