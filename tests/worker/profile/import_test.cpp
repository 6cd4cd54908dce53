// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "tests/fixture/temporary_folder.h"
#include "worker/profile/import_profile.h"

namespace skinframe {
namespace {

using nlohmann::json;

constexpr char kBundle[] = R"(# a vendor's bundle
[vendor]
name = Maker
this line is nobody's business

[printer:*common*]
bed_shape = 0x0,250x0,250x210,0x210
nozzle_diameter = 0.4,0.4
max_print_height = 200

[printer:*tall*]
max_print_height = 300

[printer:One]
inherits = *common*

[printer:Two & a Half]
inherits = *common*; *tall*
bed_shape = -90x-90,90x-90,90x90,-90x90

[printer:Resin]
printer_technology = SLA
bed_shape = 0.5x0.5,127.5x0.5,127.5x80.5,0.5x80.5
max_print_height = 150

[filament:X]
bed_shape = nonsense of another kind
)";

class Import : public testing::Test {
 protected:
  json printer(const std::string& file, const std::string& preset = "") {
    const auto draft = import_printer(folder_.path() / file, preset);
    EXPECT_TRUE(draft.ok()) << draft.error().message;
    notes_ = draft.ok() ? draft->notes() : std::vector<std::string>();
    return draft.ok() ? json::parse(draft->text())["printer"] : json();
  }
  json material(const std::string& text, const std::string& preset = "") {
    const auto draft = import_spoolman(folder_.write("filament.json", text), preset);
    EXPECT_TRUE(draft.ok()) << draft.error().message;
    notes_ = draft.ok() ? draft->notes() : std::vector<std::string>();
    return draft.ok() ? json::parse(draft->text())["material"] : json();
  }
  template <class Draft>
  void expect_refused(const Draft& draft, const std::string& says) {
    ASSERT_FALSE(draft.ok()) << says;
    EXPECT_NE(draft.error().message.find(says), std::string::npos) << draft.error().message;
  }
  Result<ProfileDraft> import(const std::string& name, const std::string& text,
                              const std::string& preset = "") {
    return import_printer(folder_.write(name, text), preset);
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> notes_;
};

TEST_F(Import, APresetOfABundleTakesFromItsParentsWhatItDoesNotSay) {
  folder_.write("bundle.ini", kBundle);
  const json one = printer("bundle.ini", "One");
  EXPECT_EQ(one["tray_x_mm"], 250);
  EXPECT_EQ(one["tray_y_mm"], 210);
  EXPECT_EQ(one["tray_z_mm"], 200);
  EXPECT_EQ(one["nozzle_mm"], 0.4);
  EXPECT_EQ(one["process"], "extrusion");
  EXPECT_EQ(one["sources"]["tray_x_mm"], "PrusaSlicer preset \"One\": bed_shape, bundle.ini line 7");
}

TEST_F(Import, OfSeveralParentsTheLastIsTheStrongest) {
  folder_.write("bundle.ini", kBundle);
  const json two = printer("bundle.ini", "Two & a Half");
  EXPECT_EQ(two["tray_z_mm"], 300);
  EXPECT_EQ(two["tray_x_mm"], 180) << "the bed's own origin may lie in its middle";
  EXPECT_EQ(two["id"], "two-a-half");
}

TEST_F(Import, WhatTheFileDoesNotSayIsNullAndNeverInvented) {
  folder_.write("bundle.ini", kBundle);
  const json one = printer("bundle.ini", "One");
  for (const char* field : {"min_radius_mm", "max_internal_radius_mm", "printable_length", "drain_holes",
                            "default_material_id", "neck_diameter_mm"})
    EXPECT_TRUE(one.at(field).is_null()) << field;
}

TEST_F(Import, AResinPrinterIsOneAndHasNoNozzle) {
  folder_.write("bundle.ini", kBundle);
  const json resin = printer("bundle.ini", "Resin");
  EXPECT_EQ(resin["process"], "resin");
  EXPECT_EQ(resin["build_direction"], "hanging");
  EXPECT_EQ(resin["tray_x_mm"], 127);
  EXPECT_TRUE(resin["nozzle_mm"].is_null());
}

TEST_F(Import, OfABundleWithoutPresetThePrintersAreTold) {
  expect_refused(import("bundle.ini", kBundle),
                 "3 printers are in it; choose one with --preset:\n  One\n  Resin");
  expect_refused(import("bundle.ini", kBundle, "Three"), "no printer \"Three\" is in it");
}

TEST_F(Import, AnExportedPresetInheritsFromFilesBesideIt) {
  folder_.write("Mine.ini", "inherits = Base\nmax_print_height = 180\n");
  folder_.write("Base.ini",
                "bed_shape = 0x0,100x0,100x120,0x120\nmax_print_height = 1\nnozzle_diameter = 0.6\n");
  const json mine = printer("Mine.ini");
  EXPECT_EQ(mine["tray_y_mm"], 120);
  EXPECT_EQ(mine["tray_z_mm"], 180);
  EXPECT_EQ(mine["nozzle_mm"], 0.6);
  EXPECT_TRUE(notes_.empty());
}

TEST_F(Import, AParentThatIsNowhereIsSaid) {
  folder_.write("Mine.ini", "inherits = Factory Default\nmax_print_height = 180\n");
  EXPECT_TRUE(printer("Mine.ini")["tray_x_mm"].is_null());
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_NE(notes_[0].find("\"Factory Default\""), std::string::npos);
}

TEST_F(Import, InheritanceInACircleIsAnError) {
  expect_refused(
      import("bundle.ini",
             "[printer:A]\ninherits = B\n[printer:B]\ninherits = C\n[printer:C]\ninherits = B\n", "A"),
      "inherits runs in a circle: B -> C -> B");
  std::string deep;
  for (int i = 0; i < 100; ++i)
    deep += "[printer:p" + std::to_string(i) + "]\ninherits = p" + std::to_string(i + 1) + "\n";
  expect_refused(import("deep.ini", deep, "p0"), "more than 64 presets");
}

TEST_F(Import, ManyWaysToOneAncestorAreWalkedOnce) {
  std::string lattice = "[printer:r0]\nmax_print_height = 77\n";
  for (int i = 1; i < 60; ++i) {  // 2^59 ways from the last to the first
    const std::string below = std::to_string(i - 1), here = std::to_string(i);
    lattice += "[printer:a" + here + "]\ninherits = r" + below + "\n[printer:r" + here + "]\ninherits = a" +
               here + "; r" + below + "\n";
  }
  folder_.write("lattice.ini", lattice);
  EXPECT_EQ(printer("lattice.ini", "r30")["tray_z_mm"], 77);
}

TEST_F(Import, AParentNeverLeadsOutOfTheFolder) {
  folder_.write("outside.ini", "max_print_height = 99\n");
  std::filesystem::create_directory(folder_.path() / "in");
  folder_.write("in/Mine.ini", "inherits = ../outside\nnozzle_diameter = 0.4\n");
  EXPECT_TRUE(printer("in/Mine.ini")["tray_z_mm"].is_null());
  folder_.write("outside.def.json", R"({"overrides": {"machine_height": {"default_value": 99}}})");
  expect_refused(import("in/cura.def.json", R"({"name": "X", "inherits": "../outside"})"),
                 "inherits: not the name");
}

TEST_F(Import, BadValuesAreSaidWithFileLineAndField) {
  expect_refused(import("a.ini", "[printer:A]\nbed_shape = 0x0,250y0\n"),
                 "a.ini:2: bed_shape: not a list of corners");
  expect_refused(import("a.ini", "[printer:A]\nbed_shape = 0x0,250x0\n"),
                 "a.ini:2: bed_shape: fewer than three corners");
  expect_refused(import("a.ini", "[printer:A]\nbed_shape = 0x0,1e99x0,3x3\n"), "a.ini:2: bed_shape");
  expect_refused(import("a.ini", "[printer:A]\nnozzle_diameter = wide\n"), "a.ini:2: nozzle_diameter");
  expect_refused(import("a.ini", "[printer:A\n"), "a.ini:1: a section without its ]");
  expect_refused(import("a.ini", "what is this\n"), "a.ini:1: not `key = value`");
  expect_refused(import("a.ini", "; nothing\n"), "a.ini: neither");
  expect_refused(import_printer(folder_.path() / "none.ini", ""), "no such file");
}

TEST_F(Import, ACuraDefinitionInheritsFromTheOnesBesideIt) {
  folder_.write("fdmprinter.def.json", R"({"name": "FDM", "settings": {"machine_settings": {"children": {
    "machine_width": {"default_value": 100}, "machine_height": {"default_value": 100},
    "machine_nozzle_size": {"default_value": 0.4}}}}})");
  folder_.write("base.def.json",
                R"({"inherits": "fdmprinter", "overrides": {"machine_height": {"default_value": 300}}})");
  folder_.write("s5.def.json", R"({"name": "Ultimaker S5", "inherits": "base",
    "overrides": {"machine_width": {"default_value": 330}, "machine_depth": {"value": "machine_width - 90"}}})");
  const json s5 = printer("s5.def.json");
  EXPECT_EQ(s5["id"], "ultimaker-s5");
  EXPECT_EQ(s5["tray_x_mm"], 330);
  EXPECT_TRUE(s5["tray_y_mm"].is_null()) << "a formula is not evaluated";
  EXPECT_EQ(s5["tray_z_mm"], 300);
  EXPECT_EQ(s5["nozzle_mm"], 0.4);
  EXPECT_EQ(s5["sources"]["nozzle_mm"], "Cura definition fdmprinter.def.json: machine_nozzle_size");
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_NE(notes_[0].find("machine_depth"), std::string::npos);
}

TEST_F(Import, CuraDefinitionsInACircleOrWithoutTheirParentAreSaid) {
  folder_.write("a.def.json", R"({"inherits": "b"})");
  expect_refused(import("b.def.json", R"({"inherits": "a"})"), "runs in a circle: b.def.json");
  folder_.write(
      "c.def.json",
      R"({"name": "C", "inherits": "elsewhere", "overrides": {"machine_width": {"default_value": 7}}})");
  EXPECT_EQ(printer("c.def.json")["tray_x_mm"], 7);
  ASSERT_EQ(notes_.size(), 1u);
  expect_refused(import("d.def.json", "{\n\"name\": oops}"), "d.def.json:2: not JSON");
  expect_refused(import("e.def.json", "[]"), "not a Cura definition");
  expect_refused(import("f.def.json", R"({"overrides": {"machine_width": {"default_value": -3}}})"),
                 "machine_width: -3");
}

constexpr char kFilament[] = R"({"id": 7, "name": "Charcoal Black", "vendor": {"id": 1, "name": "Polymaker"},
  "material": "PLA", "price": 15.5, "density": 1.31, "diameter": 1.75, "weight": 750, "spool_weight": 140})";

TEST_F(Import, AFilamentOfSpoolmanGivesNameDensityAndPricePerKg) {
  const json m = material(kFilament);
  EXPECT_EQ(m["id"], "polymaker-charcoal-black");
  EXPECT_EQ(m["display_name"], "Polymaker Charcoal Black");
  EXPECT_EQ(m["density_g_cm3"], 1.31);
  EXPECT_NEAR(m["price_per_kg"].get<double>(), 15.5 / 0.75, 1e-12);
  EXPECT_TRUE(m["tensile_modulus_mpa"].is_null());
  EXPECT_NE(m["sources"]["price_per_kg"].get<std::string>().find("750 g"), std::string::npos);
}

TEST_F(Import, APriceWithoutTheSpoolsWeightIsLeftOut) {
  EXPECT_TRUE(material(R"({"material": "PETG", "price": 20, "density": null})")["price_per_kg"].is_null());
  EXPECT_EQ(notes_.size(), 1u);
}

TEST_F(Import, OfAListOfFilamentsOneIsChosen) {
  const std::string list = std::string("[") + kFilament + R"(, {"id": 8, "name": "Blue", "density": 1.2}])";
  EXPECT_EQ(material(list, "8")["id"], "blue");
  EXPECT_EQ(material(list, "Charcoal Black")["density_g_cm3"], 1.31);
  expect_refused(import_spoolman(folder_.write("l.json", list), ""), "2 filaments are in it");
  expect_refused(import_spoolman(folder_.write("l.json", list), "9"), "no filament of id or name \"9\"");
}

TEST_F(Import, WhatIsNoFilamentIsSaid) {
  const auto refused = [&](const std::string& text, const std::string& says) {
    expect_refused(import_spoolman(folder_.write("f.json", text), ""), says);
  };
  refused("7", "f.json: is no filament");
  refused("[]", "f.json: is no filament");
  refused("[7]", "f.json: is no filament");
  refused("{}", "f.json: name: is missing");
  refused(R"({"name": 5})", "f.json: name: is not a text");
  refused(R"({"name": "x", "density": "heavy"})", "f.json: density: is no number");
  refused(R"({"name": "x", "price": -1})", "f.json: price: is no number");
  refused("{\n\n", "f.json:3: not JSON");
}

TEST_F(Import, DamagedFilesAreReadOrRefusedAndNothingElse) {
  std::mt19937 random(5);
  const std::string cura =
      R"({"name": "X", "inherits": "y", "overrides": {"machine_width": {"value": 100}}})";
  const std::string pieces = "{}[]\",:=;0.x-\n\xff";
  const auto damage = [&](std::string text) {
    for (int k = 0; k < 4; ++k) text[random() % text.size()] = pieces[random() % pieces.size()];
    return text;
  };
  int read = 0, refused = 0;
  const auto count = [&](const Result<ProfileDraft>& draft) {
    ++(draft.ok() ? read : refused);
    EXPECT_TRUE(draft.ok() || !draft.error().message.empty());
  };
  for (int round = 0; round < 300; ++round) {
    count(import("b.ini", damage(kBundle), "One"));
    count(import("c.def.json", damage(cura)));
    count(import_spoolman(folder_.write("f.json", damage(kFilament)), ""));
  }
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

TEST(IdFromName, IsWhatAProfileTakes) {
  EXPECT_EQ(id_from_name("PLA+ (Silk) 2"), "pla-silk-2");
  EXPECT_EQ(id_from_name("\xC3\xA4\xC3\xB6"), "profile");
  EXPECT_EQ(id_from_name("../../etc"), "etc");
  EXPECT_EQ(id_from_name(std::string(100, 'x')).size(), 64u);
}

}  // namespace
}  // namespace skinframe
