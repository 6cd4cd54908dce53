// SPDX-License-Identifier: GPL-3.0-or-later
// The skin's part of a frame: nodes on each piece of M1, their triangulation, the joints between pieces.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "worker/frame/sample_frame.h"
#include "worker/frame/triangulate_piece.h"

namespace skinframe {

inline constexpr double kContactSlackMm = 0.05;  // of a node's height, after projection to the fine field

// A connected piece of M1 that gets a frame.
struct SkinPiece {
  TriangleMesh surface;
  std::vector<double> edge_length_mm;
  double demand = 0.0;
  PieceSampling sampling;
  std::vector<std::size_t> openings;  // drain holes whose rim is on it, by number
};

// The largest first; what is left out is told in the warnings.
std::vector<SkinPiece> choose_pieces(const Skin& skin, double finger_edge, const StressMap* stress,
                                     const std::vector<Opening>& openings,
                                     std::vector<std::string>& warnings);

// Of all pieces together, from the options or the pieces' demand. Errors: kInvalidInput beyond kMaxSkinNodes.
Result<int> wanted_nodes(const std::vector<SkinPiece>& pieces, const FrameOptions& options);

struct SkinSample {
  Frame frame;
  std::vector<std::pair<int, int>> sharp_chords;
  int nodes_sampled = 0;
  std::vector<std::size_t> unopened;  // drain holes whose rim is not followed, by number
};

// Skin nodes, their triangulation and the joints between pieces. Pieces that cannot be joined are taken out
// of `pieces`, and all is done again without them. Errors: kCancelled; those of triangulate_piece.h.
Result<SkinSample> sample_skin(std::vector<SkinPiece>& pieces, const Skin& skin, const FrameOptions& options,
                               int total, double contact_height, std::vector<std::string>& warnings,
                               const RunContext& context);

}  // namespace skinframe
