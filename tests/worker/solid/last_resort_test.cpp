// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/last_resort.h"

#include <gmock/gmock.h>

#include "tests/worker/solid/shapes.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;
using namespace testing;

// It would be wrapped for minutes and take gigabytes.
TEST(LastResort, DustIsRefusedBeforeItIsWrapped) {
  const TriangleMesh grain = box({0, 0, 0}, {1, 1, 1});
  TriangleMesh dust;
  for (int x = 0; x < 28; ++x)
    for (int y = 0; y < 28; ++y)
      for (int z = 0; z < 28; ++z) {
        const int first = static_cast<int>(dust.vertices.size());
        for (const auto& v : grain.vertices) dust.vertices.push_back(v + 4.0 * Eigen::Vector3d(x, y, z));
        for (const auto& [a, b, c] : grain.triangles)
          dust.triangles.push_back({first + a, first + b, first + c});
      }
  const auto wrapped = wrap_as_last_resort(dust, "it is dust", {});
  ASSERT_FALSE(wrapped.ok());
  EXPECT_EQ(wrapped.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(wrapped.error().message, HasSubstr("it is dust; and a surface of 21952 parts"));
}

}  // namespace
}  // namespace skinframe
