// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/sample_frame.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "worker/frame/base_contact.h"
#include "worker/frame/follow_skin.h"
#include "worker/frame/internal_nodes.h"
#include "worker/frame/internal_struts.h"
#include "worker/frame/piece_joints.h"
#include "worker/frame/triangulate_piece.h"
#include "worker/frame/vertex_graph.h"

namespace skinframe {
namespace {

constexpr double kLeastPieceNodes = 12.0;  // a piece that asks for fewer has no frame
constexpr std::size_t kMostPieces = 32;
constexpr double kInternalPerSkinNode = 0.35;  // at most; the paper's frames have 0.12 to 0.44
constexpr double kCellOfEdge =
    0.70710678118654752;                 // volume of a node's cell in a^3: nodes packed like spheres
constexpr double kMarginInEdges = 0.25;  // of internal nodes below M1
constexpr double kPinSpacingInEdges = 1.2;
constexpr double kLeastOfPiece = 0.5;     // of a piece's volume, within its triangulation
constexpr double kBevelInVoxels = 1.5;    // how far the coarse surface may stand from M1's sharp edges
constexpr double kContactSlackMm = 0.05;  // of a node's height, after projection to the fine field

struct Piece {
  TriangleMesh surface;
  std::vector<double> edge_length_mm;
  double demand = 0.0;
  PieceSampling sampling;
};

double lowest_z(const TriangleMesh& mesh) { return bounding_box(mesh).min.z(); }

// The pieces that get a frame, the largest first; what is left out is told in the warnings.
std::vector<Piece> choose_pieces(const Skin& skin, double finger_edge, const StressMap* stress,
                                 std::vector<std::string>& warnings) {
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
    piece.sampling.chains =
        SharpChains(surface, skin.sharp_edges, kBevelInVoxels * skin.field.coarse_voxel_mm());
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

struct SkinSample {
  Frame frame;
  std::vector<std::pair<int, int>> sharp_chords;
  int nodes_sampled = 0;
};

// Skin nodes, their triangulation and the joints between pieces. Pieces that cannot be joined are taken out
// of `pieces`, and all is done again without them.
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

double mean_skin_edge(const Frame& frame) {
  double sum = 0.0;
  int count = 0;
  for (const Strut& s : frame.struts) {
    if (!s.is_skin) continue;
    sum += frame.length_mm(s);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

void measure_chords(SampledFrame& sampled, const Skin& skin) {
  const Frame& frame = sampled.frame;
  for (const Strut& s : frame.struts) {
    if (!s.is_skin) continue;
    const auto [outward, inward] = chord_deviation(frame.nodes_mm[s.a], frame.nodes_mm[s.b], skin);
    sampled.worst_outward_chord_mm = std::max(sampled.worst_outward_chord_mm, outward);
    sampled.worst_inward_chord_mm = std::max(sampled.worst_inward_chord_mm, inward);
    sampled.skin_struts_outside += outward > skin.thickness_mm;
  }
}

}  // namespace

TriangleAngles measure_angles(const Frame& frame) {
  if (frame.skin_triangles.empty()) return {};
  std::vector<double> least;
  for (const auto& t : frame.skin_triangles) {
    double angle = 180.0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = frame.nodes_mm[t[k]];
      const Eigen::Vector3d u = frame.nodes_mm[t[(k + 1) % 3]] - p, v = frame.nodes_mm[t[(k + 2) % 3]] - p;
      angle = std::min(angle, std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi);
    }
    least.push_back(angle);
  }
  std::sort(least.begin(), least.end());
  const double mean = std::accumulate(least.begin(), least.end(), 0.0) / static_cast<double>(least.size());
  return {mean, least[least.size() / 100], least.front()};
}

Status FrameOptions::validate() const {
  const auto outside = [](const char* name, double value, double low, double high) {
    return invalid_input(
        fmt::format("{} {:.6g}: must lie between {:.6g} and {:.6g}", name, value, low, high));
  };
  if (skin_nodes && (*skin_nodes < kMinSkinNodes || *skin_nodes > kMaxSkinNodes)) {
    return outside("--skin-nodes", *skin_nodes, kMinSkinNodes, kMaxSkinNodes);
  }
  if (internal_nodes && (*internal_nodes < 0 || *internal_nodes > kMaxSkinNodes)) {
    return outside("--internal-nodes", *internal_nodes, 0, kMaxSkinNodes);
  }
  if (neighbours < 1 || neighbours > 64) return outside("neighbours", neighbours, 1, 64);
  if (!(plate.tensile_modulus_mpa > 0.0) || !(plate.displacement_limit_mm > 0.0) ||
      !(plate.finger_force_n > 0.0) || !(plate.poisson_ratio >= 0.0 && plate.poisson_ratio < 0.5)) {
    return invalid_input(
        "the finger rule needs a modulus, a displacement limit and a force above 0 and a Poisson ratio "
        "in [0, 0.5)");
  }
  if (!(strut_radius_mm > 0.0)) return invalid_input("the radius of the struts must be above 0");
  if (!(contact_tolerance_mm > 0.0)) return invalid_input("the contact tolerance must be above 0");
  return ok_status();
}

Result<SampledFrame> sample_frame(const Skin& skin, const FrameOptions& options, RunContext& context) {
  if (auto status = options.validate(); !status) return status.error();
  if (skin.inner_surface.triangles.empty()) {
    return invalid_input(
        fmt::format("the body is thinner than two skins ({:.3g} mm) everywhere: there is no room for a "
                    "frame; use a larger --size",
                    2.0 * skin.thickness_mm));
  }
  SampledFrame sampled;
  sampled.finger_edge_mm = finger_edge_mm(options.plate, skin.thickness_mm);
  auto pieces = choose_pieces(skin, sampled.finger_edge_mm, options.stress, sampled.warnings);
  const auto total = wanted_nodes(pieces, options);
  if (!total) return total.error();
  sampled.skin_nodes_requested = *total;

  const double contact_height = skin.plate_z_mm + skin.thickness_mm + options.contact_tolerance_mm;
  auto sample = sample_skin(pieces, skin, options, *total, contact_height, sampled.warnings, context);
  if (!sample) return sample.error();
  sampled.frame = std::move(sample.value().frame);
  sampled.sharp_chords = std::move(sample.value().sharp_chords);
  sampled.skin_nodes_sampled = sample->nodes_sampled;
  sampled.pieces = static_cast<int>(pieces.size());
  sampled.mean_skin_edge_mm = mean_skin_edge(sampled.frame);
  if (sampled.skin_nodes_sampled != *total) {
    sampled.warnings.push_back(
        fmt::format("{} skin nodes sampled instead of {}: the shape of the body needs them",
                    sampled.skin_nodes_sampled, *total));
  }

  const double margin = std::max(2.0 * options.strut_radius_mm, kMarginInEdges * sampled.mean_skin_edge_mm);
  const InnerRoom room = find_inner_room(skin, margin);
  const double cell = kCellOfEdge * std::pow(sampled.mean_skin_edge_mm, 3);
  const int internal = options.internal_nodes.value_or(static_cast<int>(
      std::min(kInternalPerSkinNode * sampled.frame.skin_node_count, room.volume_mm3() / cell)));
  const auto inner = spread_nodes(room, internal, skin, context);
  if (context.cancelled()) return cancelled_error();
  sampled.frame.nodes_mm.insert(sampled.frame.nodes_mm.end(), inner.begin(), inner.end());
  const auto added = add_internal_struts(
      sampled.frame, {options.strut_radius_mm, options.slenderness, options.neighbours}, skin);
  sampled.struts_left_out_crossing = added.struts_crossing;

  sampled.contact_nodes =
      contact_nodes(sampled.frame.nodes_mm, sampled.frame.skin_node_count, contact_height + kContactSlackMm);
  measure_chords(sampled, skin);
  sampled.angles = measure_angles(sampled.frame);
  if (context.cancelled()) return cancelled_error();
  return sampled;
}

}  // namespace skinframe
