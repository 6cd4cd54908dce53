// SPDX-License-Identifier: GPL-3.0-or-later
// The claims, by what they are about. Each function adds its claims to the verdict; tolerances stand beside
// the claim.
#pragma once

#include "worker/check/claim.h"
#include "worker/check/exported.h"
#include "worker/check/surface.h"

namespace skinframe::check {

// The merged mesh's first triangles are M's own, as the report counts them; the rest bounds the cavity. Where
// there are drain holes, their lids close both.
void split_surfaces(const ExportedPrinter& result, TriangleMesh* outer, TriangleMesh* cavity);

// Watertight, volumes, weight, skin thickness, tray.
void claim_mesh(const ExportedPrinter& result, const TriangleMesh& outer_mesh, const TriangleMesh& cavity,
                const Surface& outer, Verdict* verdict);

// Where fine detail is smoothed: the skin's volume and what smoothing added to it, between what is solid
// without being a strut's and what is solid at all. (That the cavity keeps its distance from M is
// claim_mesh's.)
void claim_smoothing(const ExportedPrinter& result, const TriangleMesh& outer_mesh,
                     const TriangleMesh& cavity, const Surface& outer, Verdict* verdict);

// Share of M that lies within that depth of its surface, from points spread evenly over its box. The error is
// the binomial one of the count of points inside.
struct WallSample {
  double volume_mm3 = 0;
  double error_mm3 = 0;  // four standard deviations
};
WallSample sample_wall(const Surface& outer, const BoundingBox& box, double depth_mm,
                       double solid_volume_mm3);

// Drain holes and their caps, where the printer's profile has a rule for them.
void claim_drain(const ExportedPrinter& result, const TriangleMesh& outer_mesh, const TriangleMesh& cavity,
                 const Surface& outer, Verdict* verdict);

// Directed edges without their opposite, edges with more than two triangles, triangles with two equal
// corners.
struct EdgeCount {
  std::size_t unmatched = 0;
  std::size_t crowded = 0;
  std::size_t degenerate = 0;
};
EdgeCount count_edges(const TriangleMesh& mesh);

// No wall between M and the cavity is thinner than the skin less a voxel where M is thicker, by rays from M.
void claim_walls(const ExportedPrinter& result, Verdict* verdict);

// Pairs of triangles that cut each other: both among the first `own`, and all others.
struct Crossings {
  std::size_t own = 0, added = 0;
  Eigen::Vector3d first_mm = Eigen::Vector3d::Zero();  // of those added
};
Crossings count_crossings(const TriangleMesh& mesh, std::size_t own);

// The solid adds no self-intersection to those of M beyond what the report says; nor does the compact mesh.
void claim_crossings(const ExportedPrinter& result, Verdict* verdict);

// skin-frame.3mf, frame-beams.3mf and skin-frame-compact.stl, where the report lists them: the same body, in
// mm.
void claim_package(const ExportedPrinter& result, Verdict* verdict);
void claim_beams(const ExportedPrinter& result, Verdict* verdict);
void claim_compact(const ExportedPrinter& result, Verdict* verdict);

// A result called solid: the mesh is M, nothing is counted, and there was indeed nothing to hollow.
void claim_solid(const ExportedPrinter& result, const TriangleMesh& outer_mesh, const Surface& outer,
                 Verdict* verdict);

// Radii (9, 10), slenderness (4, 5), triangulation, counts and nominal volumes (12), struts inside M (7).
void claim_frame(const ExportedPrinter& result, const Surface* outer, Verdict* verdict);

// The struts of frame.json stand in skin-frame.stl: solid about their axes, wherever these run below the
// skin.
void claim_printed_struts(const ExportedPrinter& result, const TriangleMesh& cavity, const Surface& outer,
                          Verdict* verdict);

// Of extrusion printers: every strut prints, divided at its inserted nodes; every node has a way down to the
// base plane, by struts that print or by the skin; no support is without need; supports stay on their side of
// the skin; the figures are those of the exported meshes, which are closed; the deformation of the print is
// as reported.
void claim_supports(const ExportedPrinter& result, const Surface& outer, Verdict* verdict);
// p(theta) of the exported points: linear between them, the shorter one beside a point without limit,
// constant before the first.
double printable_mm(const std::vector<std::pair<double, double>>& curve, double degrees);
// No more skin hangs too far from what holds it than is reported.
void claim_overhang(const ExportedPrinter& result, const TriangleMesh& outer_mesh, const Surface& outer,
                    Verdict* verdict);
// Skin, struts, supports and those outside, sliced from the exported meshes: every connected part of a layer
// touches material of the layer below within the self-supporting angle. The base plane holds what lies within
// its reach.
void claim_layers(const ExportedPrinter& result, Verdict* verdict);

// --orient best: the estimate of added strut volume (support/orient_body.h) of the chosen attitude and of its
// runner-up, computed anew from M's triangles, are as reported, and the chosen one needs no more; it stands
// by the margin that is reported.
void claim_orientation(const ExportedOrientation& orientation, const ExportedPrinter& result,
                       const TriangleMesh& outer_mesh, Verdict* verdict);
// Of a body's centroid inside the hull of its base contact; negative outside.
double standing_margin_mm(const TriangleMesh& outer_mesh);

// The struts of each stage: as many as reported, of the reported volume, no radius below its bound; before
// and after sizing of the same lengths, and those of the frame that was given.
void claim_stages(const ExportedPrinter& result, Verdict* verdict);

// Under gravity alone, one a node; empty where the stiffness is singular.
std::vector<Eigen::Vector3d> own_weight_displacements_mm(const ExportedFrame& frame);

// Of a frame problem: radii within each strut's own bounds (9, 10), slenderness (4, 5), counts and volumes
// (12), balance (8).
void claim_solution(const ExportedPrinter& solution, Verdict* verdict);

// The valid model's figures: each load's largest displacement is that of its deformation file, whose vertices
// stand on the frame's nodes; safety and buckling follow from the figures of loads, the pinch from its sites;
// rows of the comparison say who is better; the hollow has the printed mass.
void claim_verified(const ExportedPrinter& result, const TriangleMesh& body, const Surface& outer,
                    Verdict* verdict);

// Equilibrium (1), stresses (2, 3), displacement (6): assembled and solved anew, in the paper's model or the
// pin-jointed one, as the file says.
void claim_mechanics(const ExportedPrinter& result, Verdict* verdict);

// That no radii within their bounds keep the limits, where the report says that this is proven; and the lower
// bounds on the volume: below the volumes that they are bounds of, the gaps as reported, and for a frame
// problem proven. Each proof is verified by arithmetic alone, without solving anything: virtual displacements
// y of a load case give 2 F^T y - y^T K y <= F^T D <= what the limits allow, linear in the areas, whose sum
// with multipliers >= 0 is least strut by strut.
void claim_bounds(const ExportedPrinter& result, Verdict* verdict);

// Of skin and struts together, each strut counted in full.
Eigen::Vector3d nominal_centre_of_gravity_mm(const ExportedFrame& frame);

// Balance (8): of the nominal model, and of the printed mesh itself.
void claim_balance(const ExportedPrinter& result, const TriangleMesh& outer_mesh, Verdict* verdict);

}  // namespace skinframe::check
