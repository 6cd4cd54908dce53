// SPDX-License-Identifier: Apache-2.0
#include "server/app/profile_watch.h"

#include <gtest/gtest.h>

#include "tests/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

std::string material(const std::string& id, const std::string& density = "1") {
  return R"({"material": {"id": ")" + id + R"(", "display_name": "M", "density_g_cm3": )" + density +
         R"(, "source": "s"}})";
}

class ProfileWatchTest : public testing::Test {
 protected:
  static constexpr Milliseconds kEvery{1000};

  void look() {  // the next look at the folder
    now_ += kEvery;
    EXPECT_TRUE(watch_.run_once(now_).ok());
  }
  bool known(const std::string& id) const { return catalog_.current()->find_material(id) != nullptr; }

  test::TemporaryFolder folder_;
  LiveCatalog catalog_{built_in_catalog()};
  ProfileWatch watch_{folder_.path(), catalog_, kEvery};
  Time now_{Milliseconds(1'000'000)};
};

TEST_F(ProfileWatchTest, AChangeIsReadOnceTheFolderHasKeptStill) {
  look();
  folder_.write("m.json", material("m"));
  look();
  EXPECT_FALSE(known("m")) << "whoever copies may not be done";
  look();
  EXPECT_TRUE(known("m"));
}

TEST_F(ProfileWatchTest, AskedItReadsAtOnce) {
  folder_.write("m.json", material("m"));
  EXPECT_TRUE(watch_.run_once(now_).ok());
  watch_.reload();
  EXPECT_TRUE(watch_.run_once(now_).ok()) << "long before the next look";
  EXPECT_TRUE(known("m"));
}

TEST_F(ProfileWatchTest, ABadFileLeavesTheCatalogueBeforeInForceUntilItIsMended) {
  folder_.write("m.json", material("m"));
  watch_.reload();
  look();
  ASSERT_TRUE(known("m"));
  folder_.write("m.json", material("m", "-7"));
  folder_.write("n.json", material("n"));
  for (int i = 0; i < 3; ++i) look();
  EXPECT_EQ(catalog_.current()->find_material("m")->density_g_cm3(), 1);
  EXPECT_FALSE(known("n")) << "all or nothing";
  folder_.write("m.json", material("m", "2.25"));
  look();
  look();
  EXPECT_EQ(catalog_.current()->find_material("m")->density_g_cm3(), 2.25);
  EXPECT_TRUE(known("n"));
}

TEST_F(ProfileWatchTest, WhoeverLooksThingsUpKeepsTheCatalogueHeTook) {
  const auto before = catalog_.current();
  folder_.write("m.json", material("m"));
  watch_.reload();
  look();
  EXPECT_TRUE(known("m"));
  EXPECT_EQ(before->find_material("m"), nullptr);
}

}  // namespace
}  // namespace skinframe::server
