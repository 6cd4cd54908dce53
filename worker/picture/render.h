// SPDX-License-Identifier: GPL-3.0-or-later
// `skinframe render`: every picture that a result folder's files allow.
//
//   frame.png               frame.json            struts coloured by radius
//   cutaway.png             skin-frame.stl        the printed solid cut open
//   radii.png, lengths.png  frame.json            the struts' sizes before and after each stage
//   deformation-NAME.png    deformation-NAME.ply  the surface in its own colours
//   pinch.png               pinch.ply             how far two fingers press it together, by place
//
// For each printer, into its folder; of a frame job from result.json, beside it. What has no file has no
// picture. Same files, same pictures, byte for byte.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "worker/run/result.h"
#include "worker/run/run_context.h"

namespace skinframe::picture {

struct RenderRequest {
  std::filesystem::path directory;
  std::filesystem::path out;  // empty: the directory itself; folders of printers are made in it
  std::string printer;        // empty: all
  int side_px = 1000;         // [kLeastSidePx, kMostSidePx]

  Status validate() const;
};

// The files written, in order. Errors: kIo and kInvalidInput of what is
// read, kInternal where nothing can be written, kCancelled; what was written before stays.
Result<std::vector<std::filesystem::path>> render(const RenderRequest& request, RunContext& context);

}  // namespace skinframe::picture
