// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/queue_figures.h"

#include <gtest/gtest.h>

namespace skinframe::server {
namespace {

TEST(QueueFigures, TheTenantsWithTheMostJobsHaveRowsAndTheRestShareOneThatLosesNothing) {
  std::vector<TenantFigures> all;
  for (int i = 0; i < 50; ++i)
    all.push_back(
        {std::to_string(i), i, 1, i % 2 == 0 ? std::optional(Time(Milliseconds(1000 + i))) : std::nullopt});
  const auto rows = bounded(all, 3);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].tenant, "49");
  EXPECT_EQ(rows[2].tenant, "47");
  EXPECT_EQ(rows[3].tenant, "(others)");
  EXPECT_EQ(rows[3].queued, 46 * 47 / 2);
  EXPECT_EQ(rows[3].running, 47);
  EXPECT_EQ(rows[3].oldest_queued, Time(Milliseconds(1000)));
  EXPECT_EQ(bounded(all, 50).size(), 50u) << "nobody shares where all have room";
}

}  // namespace
}  // namespace skinframe::server
