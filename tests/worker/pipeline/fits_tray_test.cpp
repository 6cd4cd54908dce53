// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/fits_tray.h"

#include <gmock/gmock.h>

#include "tests/worker/solid/shapes.h"

namespace skinframe {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

PrinterProfile makerbot() {
  PrinterProfile printer;
  printer.id = "makerbot-replicator-2";
  printer.tray_mm = {225, 145, 150};
  return printer;
}

Solid block(double x, double y, double z) {
  auto solid = Solid::make(testing::box({0, 0, 0}, {x, y, z}));
  SKINFRAME_CHECK(solid.ok());
  return std::move(solid).value();
}

TEST(FitsTray, ABodyOfTheTraysSizeFitsBothWays) {
  EXPECT_TRUE(fits_tray(block(225, 145, 150), makerbot()).ok());
  EXPECT_TRUE(fits_tray(block(145, 225, 150), makerbot()).ok());
}

TEST(FitsTray, EveryAxisThatIsTooLongIsNamedWithItsExcess) {
  const Status refused = fits_tray(block(230, 140, 162.5), makerbot());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kDoesNotFit);
  EXPECT_THAT(refused.error().message, AllOf(HasSubstr("5.0 mm too long in x, 12.5 mm too high in z"),
                                             Not(HasSubstr("in y")), HasSubstr("--size 212 or less")));
}

TEST(FitsTray, TheTurnIsToldOf) {
  const Status refused = fits_tray(block(140, 300, 10), makerbot());
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr("turned about z: 75.0 mm too long in y"), HasSubstr("--size 225 or less")));
}

TEST(FitsTray, NoBodyIsLaidDown) {
  EXPECT_THAT(fits_tray(block(20, 20, 200), makerbot()).error().message, HasSubstr("50.0 mm too high in z"));
}

}  // namespace
}  // namespace skinframe
