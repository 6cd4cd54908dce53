// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/sample_skin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "worker/frame/base_contact.h"
#include "worker/frame/follow_skin.h"
#include "worker/frame/open_rims.h"
#include "worker/frame/piece_joints.h"
#include "worker/frame/vertex_graph.h"

namespace skinframe {
namespace {

using Piece = SkinPiece;

constexpr double kLeastPieceNodes = 12.0;  // a piece that asks for fewer has no frame
constexpr std::size_t kMostPieces = 32;
constexpr double kPinSpacingInEdges = 1.2;
constexpr double kLeastOfPiece = 0.5;   // of a piece's volume, within its triangulation
constexpr double kAtRimInVoxels = 3.0;  // a piece's surface at the rim of a drain hole
constexpr double kBevelInVoxels = 1.5;  // how far the coarse surface may stand from M1's sharp edges

double lowest_z(const TriangleMesh& mesh) { return bounding_box(mesh).min.z(); }

// Shares by demand; what rounding leaves goes to the largest piece, so that the sum is exact.
void share_nodes(std::vector<Piece>& pieces, int total) {
  double demand = 0.0;
  for (const Piece& piece : pieces) demand += piece.demand;
  int given = 0;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const double share = demand > 0.0 ? total * pieces[i].demand / demand : 0.0;
    pieces[i].sampling.nodes = std::max(4, static_cast<int>(std::lround(share)));
    given += pieces[i].sampling.nodes;
  }
  pieces[0].sampling.nodes = std::max(4, total - given);
}

void pin_contact(std::vector<Piece>& pieces, double contact_z, double spacing) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::pair<int, int>> source;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].sampling.contact_z_mm = contact_z;
    pieces[i].sampling.pins.clear();
    for (std::size_t v = 0; v < pieces[i].surface.vertices.size(); ++v) {
      if (pieces[i].surface.vertices[v].z() > contact_z) continue;
      points.push_back(pieces[i].surface.vertices[v]);
      source.emplace_back(static_cast<int>(i), static_cast<int>(v));
    }
  }
  for (int pin : choose_pins(points, spacing)) {
    pieces[source[pin].first].sampling.pins.push_back(source[pin].second);
  }
}

void pin_joints(std::vector<Piece>& pieces, double radius, const Skin& skin) {
  if (pieces.size() < 2) return;
  std::vector<const TriangleMesh*> surfaces;
  for (const Piece& piece : pieces) surfaces.push_back(&piece.surface);
  const auto pins = joint_pins(surfaces, radius, skin);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].sampling.pins.insert(pieces[i].sampling.pins.end(), pins[i].begin(), pins[i].end());
  }
}

// From the coarse surface onto the fine field's M1, not far.
Eigen::Vector3d settle(const Eigen::Vector3d& p, const Skin& skin) {
  const Eigen::Vector3d step = onto_m1(p, skin) - p;
  const double reach = 0.5 * skin.field.coarse_voxel_mm();
  return p + std::min(1.0, reach / std::max(step.norm(), 1e-12)) * step;
}

// Pins and what stands on the base contact stay where they are when the triangles are made round.
std::vector<char> held_nodes(const TriangleMesh& mesh, const Piece& piece, double contact_z) {
  std::vector<char> held(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < held.size(); ++v) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    held[v] = p.z() <= contact_z + kContactSlackMm ||
              std::any_of(piece.sampling.pins.begin(), piece.sampling.pins.end(),
                          [&](int pin) { return piece.surface.vertices[pin] == p; });
  }
  return held;
}

void add_skin_piece(Frame& frame, const TriangleMesh& mesh) {
  const int first = static_cast<int>(frame.nodes_mm.size());
  frame.nodes_mm.insert(frame.nodes_mm.end(), mesh.vertices.begin(), mesh.vertices.end());
  frame.skin_node_count = static_cast<int>(frame.nodes_mm.size());
  for (const auto& t : mesh.triangles)
    frame.skin_triangles.push_back({first + t[0], first + t[1], first + t[2]});
  const VertexGraph graph = vertex_graph(mesh);
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    for (int i = graph.first[v]; i < graph.first[v + 1]; ++i) {
      if (graph.neighbour[i] > v) frame.struts.push_back({first + v, first + graph.neighbour[i], true});
    }
  }
}

// Where two sharp edges run closer than the grid that M1 was read from (thin plates), chains along them may
// turn the surface inside out: then it is done without.
Result<PieceTriangulation> triangulate(const Piece& piece, const RunContext& context) {
  auto made = triangulate_piece(piece.surface, piece.sampling, context);
  if (!made || piece.sampling.chains.empty() ||
      signed_volume(made->mesh) >= kLeastOfPiece * signed_volume(piece.surface))
    return made;
  PieceSampling plain = piece.sampling;
  plain.chains = {};
  return triangulate_piece(piece.surface, plain, context);
}

}  // namespace

std::vector<SkinPiece> choose_pieces(const Skin& skin, double finger_edge, const StressMap* stress,
                                     const std::vector<Opening>& openings,
                                     std::vector<std::string>& warnings) {
  std::vector<SharpCurve> rims;
  for (const Opening& opening : openings) rims.push_back(rim_curve(opening, skin));
  std::vector<SharpCurve> curves;  // rims first: where a sharp edge is too near, it yields
  for (const SharpCurve& rim : rims)
    if (!rim.points_mm.empty()) curves.push_back(rim);
  curves.insert(curves.end(), skin.sharp_edges.begin(), skin.sharp_edges.end());
  std::vector<Piece> pieces;
  int left_out = 0;
  double volume = 0.0;
  for (auto& surface : split_pieces(skin.inner_surface)) {
    Piece piece;
    piece.edge_length_mm = edge_length_field(surface, finger_edge, skin.thickness_mm);
    piece.demand = node_demand(surface, piece.edge_length_mm);
    if (stress != nullptr) weigh_by_stress(surface, *stress, finger_edge, piece.edge_length_mm);
    if (!pieces.empty() && (piece.demand < kLeastPieceNodes || pieces.size() == kMostPieces)) {
      ++left_out;
      volume += signed_volume(surface);
      continue;
    }
    piece.sampling.chains = SharpChains(surface, curves, kBevelInVoxels * skin.field.coarse_voxel_mm());
    for (std::size_t i = 0; i < rims.size(); ++i)
      if (has_rim(surface, rims[i], kAtRimInVoxels * skin.field.coarse_voxel_mm()))
        piece.openings.push_back(i);
    piece.surface = std::move(surface);
    pieces.push_back(std::move(piece));
  }
  if (left_out > 0) {
    warnings.push_back(
        fmt::format("{} small hollows of the body ({:.3g} mm3 together) have a skin but no frame: they "
                    "are too small or too many for a triangulation",
                    left_out, volume));
  }
  return pieces;
}

Result<int> wanted_nodes(const std::vector<Piece>& pieces, const FrameOptions& options) {
  if (options.skin_nodes) return *options.skin_nodes;
  double demand = 0.0;
  for (const Piece& piece : pieces) demand += piece.demand;
  if (demand > kMaxSkinNodes) {
    return invalid_input(
        fmt::format("the skin asks for {:.0f} nodes, more than {}: use --skin-nodes N or a smaller "
                    "--size",
                    demand, kMaxSkinNodes));
  }
  return std::max(kMinSkinNodes, static_cast<int>(std::lround(demand)));
}

Result<SkinSample> sample_skin(std::vector<Piece>& pieces, const Skin& skin, const FrameOptions& options,
                               int total, double contact_height, std::vector<std::string>& warnings,
                               const RunContext& context) {
  while (true) {
    share_nodes(pieces, total);
    double lowest = lowest_z(pieces[0].surface);
    for (const Piece& piece : pieces) lowest = std::min(lowest, lowest_z(piece.surface));
    const double contact_z = std::max(contact_height, lowest + options.contact_tolerance_mm);
    const auto& lengths = pieces[0].edge_length_mm;
    const double typical =
        std::accumulate(lengths.begin(), lengths.end(), 0.0) / static_cast<double>(lengths.size());
    pin_contact(pieces, contact_z, kPinSpacingInEdges * typical);
    pin_joints(pieces, options.strut_radius_mm, skin);

    SkinSample sample;
    Frame& frame = sample.frame;
    int struts_left = 0;
    std::vector<int> piece_of;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      pieces[i].sampling.edge_length_mm = pieces[i].edge_length_mm;
      auto piece = triangulate(pieces[i], context);
      if (!piece) return piece.error();
      TriangleMesh& mesh = piece.value().mesh;
      std::vector<char> held = held_nodes(mesh, pieces[i], contact_z);
      for (std::size_t v = 0; v < held.size(); ++v) {
        held[v] = held[v] || piece->on_sharp_edge[v];
        if (!piece->on_sharp_edge[v]) mesh.vertices[v] = settle(mesh.vertices[v], skin);
      }
      sample.nodes_sampled += static_cast<int>(mesh.vertices.size());
      const auto followed = follow_skin(mesh, held, piece.value().sharp_chords, skin, context);
      if (!followed) return followed.error();
      struts_left += followed->edges_left;
      for (const std::size_t k : pieces[i].openings)
        if (!open_rim(mesh, piece.value().sharp_chords, options.openings[k], skin.thickness_mm))
          sample.unopened.push_back(k);
      const int first = static_cast<int>(frame.nodes_mm.size());
      for (const auto& [a, b] : piece->sharp_chords) sample.sharp_chords.emplace_back(first + a, first + b);
      add_skin_piece(frame, mesh);
      piece_of.resize(frame.nodes_mm.size(), static_cast<int>(i));
    }
    const auto joined = join_pieces(frame, piece_of, options.strut_radius_mm, skin);
    if (std::all_of(joined.begin(), joined.end(), [](bool j) { return j; })) {
      if (struts_left > 0)
        warnings.push_back(fmt::format(
            "{} skin struts leave the inner surface of the skin by more than {:.2g} mm outwards or "
            "{:.2g} mm inwards and could not be divided further",
            struts_left, kOutwardInThicknesses * skin.thickness_mm,
            kInwardInThicknesses * skin.thickness_mm));
      return sample;
    }
    std::vector<Piece> kept;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (joined[i]) {
        kept.push_back(std::move(pieces[i]));
        continue;
      }
      warnings.push_back(
          fmt::format("a hollow of the body ({:.3g} mm3) has a skin but no frame: no strut of {:.3g} mm "
                      "radius joins it to the rest",
                      signed_volume(pieces[i].surface), options.strut_radius_mm));
    }
    pieces = std::move(kept);
  }
}

}  // namespace skinframe
