// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies with the skin of 1 mm that holes are tried on.
#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "tests/worker/skin/bodies.h"
#include "worker/skin/build_skin.h"

namespace skinframe::hollow {

struct Body {
  TriangleMesh mesh;
  Skin skin;
};

inline Body make(TriangleMesh mesh) {
  RunContext context;
  auto skin = build_skin(mesh, {.thickness_mm = 1.0, .voxel_mm = 0.8}, context);
  EXPECT_TRUE(skin.ok()) << skin.error().message;
  return {std::move(mesh), std::move(skin.value())};
}

}  // namespace skinframe::hollow
