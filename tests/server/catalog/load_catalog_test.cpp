// SPDX-License-Identifier: Apache-2.0
// The operator's folder beside the built-in profiles.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "server/catalog/catalog.h"
#include "tests/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

std::string printer(const std::string& id, const std::string& material, double radius) {
  return "{\"printer\": {\"id\": \"" + id + "\", \"display_name\": \"P\", \"process\": \"powder\",\n" +
         "\"default_material_id\": \"" + material + "\",\n\"min_radius_mm\": " + std::to_string(radius) +
         ", \"source\": \"s\"}}";
}
std::string material(const std::string& id) {
  return R"({"material": {"id": ")" + id + R"(", "display_name": "M", "density_g_cm3": 1, "source": "s"}})";
}

class LoadCatalog : public testing::Test {
 protected:
  void expect_refused(const std::string& says) {
    const auto loaded = load_catalog(folder_.path());
    ASSERT_FALSE(loaded.ok());
    EXPECT_NE(loaded.status().message().find(says), absl::string_view::npos) << loaded.status();
  }
  test::TemporaryFolder folder_;
};

TEST_F(LoadCatalog, FilesJoinTheBuiltInProfilesAndTakeThePlaceOfOneOfTheirId) {
  folder_.write("mine.json", printer("mine", "my-powder", 0.7));
  folder_.write("powder.json", material("my-powder"));
  folder_.write("p1.json", printer("sinterstation-hiq", "pa", 0.6));
  folder_.write("notes.txt", "not a profile");
  folder_.write(".hidden.json", "not looked at");
  const auto loaded = load_catalog(folder_.path());
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_EQ(loaded->find_printer("mine")->min_radius_mm(), 0.7);
  EXPECT_EQ(loaded->find_printer("sinterstation-hiq")->min_radius_mm(), 0.6);
  EXPECT_FALSE(loaded->find_printer("sinterstation-hiq")->has_tray_x_mm()) << "nothing is mixed into it";
  EXPECT_NE(loaded->find_material("my-powder"), nullptr);
  EXPECT_EQ(loaded->printers().size(), built_in_catalog().printers().size() + 1);
}

TEST_F(LoadCatalog, AnEmptyFolderIsTheBuiltInCatalogue) {
  const auto loaded = load_catalog(folder_.path());
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_EQ(loaded->printer_ids(), built_in_catalog().printer_ids());
}

TEST_F(LoadCatalog, OneIdInTwoFilesNamesBoth) {
  folder_.write("a.json", material("m"));
  folder_.write("b.json", material("m"));
  expect_refused("b.json:1: id: \"m\" is that of ");
  expect_refused("a.json too");
}

TEST_F(LoadCatalog, AnUnknownDefaultMaterialIsNamedWithItsLine) {
  folder_.write("a.json", printer("p", "nowhere", 0.5));
  expect_refused("a.json:2: printer.default_material_id: there is no material \"nowhere\"");
}

TEST_F(LoadCatalog, ABadFileOrNoFolderIsSaid) {
  EXPECT_EQ(load_catalog(folder_.path() / "none").status().code(), absl::StatusCode::kNotFound);
  folder_.write("a.json", "{\n\"printer\": oops}");
  expect_refused("a.json:2: not JSON");
}

TEST_F(LoadCatalog, APipeIsNotWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe.json").c_str(), 0600), 0);
  expect_refused("pipe.json:1: not a regular file");
}

}  // namespace
}  // namespace skinframe::server
