// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of bodies, made by the pipeline's own stages: a sample body or a mesh file, 200 mm large, printed
// with PA on the powder printer of the paper.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tests/bench/frames/ellipsoid.h"
#include "worker/frame/sample_frame.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/run/result.h"
#include "worker/skin/build_skin.h"

namespace skinframe::bench {

// What a frame of any size is made of.
struct PreparedBody {
  PreparedSolid prepared;
  Skin skin;
};

Result<PreparedBody> prepare_sample(const std::string& name);
Result<PreparedBody> prepare_mesh_file(const std::filesystem::path& path);

// `size`: the skin gets `skin_share` of the nodes, and the neighbours of internal nodes are chosen so that
// the struts come as near to the wanted number as whole numbers allow. None: the pipeline's default counts.
struct BodySize {
  FrameSize size;
  double skin_share = 0.6;
};
Result<SampledFrame> sample_body(const PreparedBody& body, const std::optional<BodySize>& size);

// Supports, bounds, weights; self weight is the only load case. `balance` asks for (8) where the solid
// stands.
Result<FrameProblem> pose_body(const PreparedBody& body, const SampledFrame& sampled, bool balance);

}  // namespace skinframe::bench
