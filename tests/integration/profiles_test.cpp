// SPDX-License-Identifier: Apache-2.0
// Printers and materials through the real programs: listed, shown, imported, calibrated, read from a folder
// and read again while the server runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/integration/farm.h"
#include "tests/integration/process.h"

namespace skinframe::integration {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Profiles : public testing::Test {
 protected:
  Profiles() { std::filesystem::create_directory(folder()); }

  std::filesystem::path folder() const { return scratch_ / "profiles"; }
  std::string write(const std::string& name, const std::string& content) {
    std::ofstream(scratch_ / name, std::ios::binary) << content;
    return scratch_ / name;
  }
  Ran skinframe(std::vector<std::string> words) {
    words.insert(words.begin(), binary("skinframe"));
    return run(words, scratch_.path());
  }
  json parsed(const Ran& ran) {
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return json::parse(ran.out, nullptr, false);
  }
  void expect_sentence(const Ran& ran, int code, const std::string& about) {
    EXPECT_EQ(ran.exit_code, code) << ran.out << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(about));
  }

  Scratch scratch_;
};

TEST_F(Profiles, AreListedAndShownWithTheirSources) {
  const Farm farm(scratch_);
  EXPECT_THAT(farm.ask({"printers"}).out, HasSubstr("makerbot-replicator-2"));
  EXPECT_THAT(farm.ask({"materials"}).out, HasSubstr("petg"));
  const Ran sheet = farm.ask({"printers", "show", "makerbot-replicator-2"});
  EXPECT_EQ(sheet.exit_code, 0) << sheet.err;
  EXPECT_THAT(sheet.out, HasSubstr("Wang et al. 2013"));
  EXPECT_THAT(sheet.out, HasSubstr("a default, not measured"));
  const json petg = parsed(farm.ask({"materials", "show", "petg", "--json"}))["material"];
  EXPECT_TRUE(petg.at("shear_modulus_mpa").is_null());
  EXPECT_EQ(petg["density_g_cm3"], 1.27);
  expect_sentence(farm.ask({"printers", "show", "nobodys"}), 2, "unknown printer \"nobodys\"; known: ");
}

TEST_F(Profiles, WhatIsShownIsAFileThatTheServerTakes) {
  const Farm built_in(scratch_);
  for (const auto& [verb, id] : {std::pair{"printers", "prusa-sl1s"},
                                 {"printers", "sinterstation-hiq"},
                                 {"printers", "bambu-x1-carbon"},
                                 {"materials", "formlabs-durable"}})
    write(std::string("profiles/") + id + ".json", built_in.ask({verb, "show", id, "--json"}).out);
  Process server({binary("skinframe-server"), "--listen", "127.0.0.1:0", "--data", scratch_ / "data-2",
                  "--port-file", scratch_ / "port-2", "--profiles", folder()},
                 scratch_ / "server-2");
  EXPECT_TRUE(eventually([&] { return !read_file(scratch_ / "port-2").empty() || !server.running(); }));
  EXPECT_TRUE(server.running()) << server.err();
}

TEST_F(Profiles, AFolderIsReadAgainAndABadFileChangesNothing) {
  const auto material = [](const std::string& id, const std::string& density) {
    return "{\"material\": {\n\"id\": \"" + id + "\", \"display_name\": \"M\", \"source\": \"s\",\n" +
           "\"density_g_cm3\": " + density + "}}";
  };
  write("profiles/m.json", material("mine", "1.5"));
  Farm farm(scratch_, {"--profiles", folder()});
  const auto density = [&] {
    const Ran ran = farm.ask({"materials", "show", "mine", "--json"});
    return ran.exit_code == 0 ? json::parse(ran.out)["material"]["density_g_cm3"].get<double>() : -1;
  };
  EXPECT_EQ(density(), 1.5);
  write("profiles/m.json", material("mine", "\"heavy\""));
  farm.server().signal(SIGHUP);
  EXPECT_TRUE(eventually([&] {
    return farm.server().err().find("m.json:3: material.density_g_cm3: is not a number") != std::string::npos;
  })) << farm.server().err();
  EXPECT_EQ(density(), 1.5);
  write("profiles/m.json", material("mine", "1.75"));  // no signal: the change is seen
  EXPECT_TRUE(eventually([&] { return density() == 1.75; })) << farm.server().err();
  farm.stop_server();
}

TEST_F(Profiles, AServerDoesNotStartOverABadFile) {
  write("profiles/bad.json", "{\n\"printer\": {\"id\": \"x\"}}");
  expect_sentence(run({binary("skinframe-server"), "--listen", "127.0.0.1:0", "--data", scratch_ / "data",
                       "--profiles", folder()},
                      scratch_.path()),
                  1, "bad.json:2: printer.display_name: is missing");
}

TEST_F(Profiles, AJobWhoseProfileDoesNotKnowWhatItNeedsIsRefusedByTheFieldsName) {
  const std::string egg = scratch_ / "egg.stl";
  ASSERT_EQ(skinframe({"sample", "egg", "--out", egg}).exit_code, 0);
  const std::string bundle = write("bundle.ini",
                                   "[printer:*common*]\nbed_shape = 0x0,250x0,250x210,0x210\n"
                                   "[printer:Mine]\ninherits = *common*\nmax_print_height = 210\n");
  const Ran imported = skinframe({"printers", "import", bundle, "--out", folder() / "mine.json"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_THAT(imported.err, HasSubstr("not known (null): min_radius_mm, max_internal_radius_mm, nozzle_mm"));
  const Farm farm(scratch_, {"--profiles", folder()});
  expect_sentence(
      farm.ask({"submit", egg, "--printer", "mine"}), 2,
      "printer \"mine\": a job needs min_radius_mm, max_internal_radius_mm, printable_length, which "
      "its profile does not know");
  expect_sentence(farm.ask({"submit", egg, "--printer", "makerbot-replicator-2", "--material", "petg"}), 2,
                  "material \"petg\": a job needs shear_modulus_mpa");
}

TEST_F(Profiles, ImportsFromOtherProgramsPrintAProfileFile) {
  const std::string cura =
      write("ender.def.json",
            R"({"name": "Creality Ender-3", "overrides": {"machine_width": {"default_value": 220}}})");
  const json printer = parsed(skinframe({"printers", "import", cura}))["printer"];
  EXPECT_EQ(printer["tray_x_mm"], 220);
  EXPECT_TRUE(printer["tray_z_mm"].is_null());
  const std::string spool =
      write("f.json", R"({"name": "Blue", "density": 1.24, "price": 25, "weight": 1000})");
  const json material = parsed(skinframe({"materials", "import", spool, "--id", "blue-pla"}))["material"];
  EXPECT_EQ(material["id"], "blue-pla");
  EXPECT_EQ(material["price_per_kg"], 25);
  expect_sentence(skinframe({"materials", "import", write("g.json", "{\n}}")}), 3, "g.json:2: not JSON");
  expect_sentence(skinframe({"printers", "import", "none.ini"}), 3, "none.ini: there is no such file");
  EXPECT_EQ(skinframe({"printers", "import"}).exit_code, 2);
}

TEST_F(Profiles, ACalibratedCurveGoesIntoAProfile) {
  const std::string points = write("points.csv", "angle_deg,length_mm\n40,80\n60,22\n75,24\n90,9\n");
  const Ran told = skinframe({"calibrate", points, "--out", scratch_ / "fragment.json"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("residual: rms 0.707 mm, largest 1.000 mm"));
  const json fit = parsed(skinframe({"calibrate", points, "--json"}));
  EXPECT_EQ(fit["residuals"].size(), 4u);
  EXPECT_NEAR(fit["residuals"][1]["fitted_mm"].get<double>(), 23, 1e-5);

  Farm farm(scratch_, {"--profiles", folder()});
  json profile = parsed(farm.ask({"printers", "show", "makerbot-replicator-2", "--json"}));
  profile["printer"]["printable_length"] =
      json::parse(read_file(scratch_ / "fragment.json"))["printable_length"];
  write("profiles/mine.json", profile.dump(2));
  farm.server().signal(SIGHUP);
  EXPECT_TRUE(eventually([&] {
    const Ran sheet = farm.ask({"printers", "show", "makerbot-replicator-2"});
    return sheet.out.find("measured") != std::string::npos &&
           sheet.out.find("not measured") == std::string::npos;
  })) << farm.server().err();
}

TEST_F(Profiles, CalibrationSaysWhatItCannotUse) {
  const std::string short_one = write("short.csv", "angle_deg,length_mm\n40,80\n60,22\n");
  EXPECT_THAT(skinframe({"calibrate", short_one}).out,
              HasSubstr("nothing is known of struts flatter than 60"));
  expect_sentence(skinframe({"calibrate", short_one, "--out", scratch_ / "f.json"}), 3,
                  "the flattest strut stands at 60");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "f.json"));
  expect_sentence(skinframe({"calibrate", write("bad.csv", "angle_deg,length_mm\n40,80\n95,2\n")}), 3,
                  "bad.csv:3: angle_deg");
  EXPECT_THAT(skinframe({"calibrate", "--help"}).out, HasSubstr("angle_deg,length_mm"));
}

TEST_F(Profiles, RunTakesAFolderToo) {
  const std::string egg = scratch_ / "egg.stl";
  ASSERT_EQ(skinframe({"sample", "egg", "--out", egg}).exit_code, 0);
  write("profiles/bad.json", "{}");
  expect_sentence(
      skinframe({"run", egg, "--printer", "mine", "--profiles", folder(), "--out", scratch_ / "out"}), 5,
      "bad.json:1: a profile file is");
}

}  // namespace
}  // namespace skinframe::integration
