// SPDX-License-Identifier: Apache-2.0
// The main job over bodies, printers and loads: it ends SUCCEEDED or INFEASIBLE and never otherwise, every
// claim of what it wrote is checked, and a slicer takes the mesh as manifold.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>

#include "tests/integration/process.h"

namespace skinframe::integration {
namespace {

using nlohmann::json;

struct Body {
  std::string name;
  bool shared = false;      // of the corpus, not ours
  bool thin_limbs = false;  // exempt from the bound on the ratio
};
void PrintTo(const Body& body, std::ostream* out) { *out << body.name; }

struct Setting {
  std::string printer, size_mm;
};
void PrintTo(const Setting& setting, std::ostream* out) {
  *out << setting.printer << " at " << setting.size_mm << " mm";
}

class MainJob : public testing::TestWithParam<std::tuple<Body, Setting, bool>> {};

TEST_P(MainJob, EndsAsItShouldAndItsFilesKeepTheirClaims) {
  const auto& [body, setting, loaded] = GetParam();
  Scratch scratch;
  std::string mesh = scratch / (body.name + ".stl");
  if (body.shared) {
    const char* models = std::getenv("SKINFRAME_MODELS");
    mesh = std::string(models != nullptr ? models : SKINFRAME_DEFAULT_MODELS) + "/good/" + body.name + ".obj";
    ASSERT_TRUE(std::filesystem::exists(mesh)) << mesh << " is absent";
  } else {
    ASSERT_EQ(run({binary("skinframe"), "sample", body.name, "--out", mesh}, scratch.path()).exit_code, 0);
  }
  const auto out = scratch / "result";
  std::vector<std::string> words = {binary("skinframe"), "run",           mesh,
                                    "--printer",         setting.printer, "--size",
                                    setting.size_mm,     "--out",         out};
  if (loaded) {
    words.insert(words.end(), {"--load", "side:top:20,0,0"});
  } else {
    words.insert(words.end(), {"--verify", "off"});  // of the same body under a load: for the time it takes
  }
  const Ran ran = run(words, scratch.path(), Seconds(600));
  ASSERT_TRUE(ran.exit_code == 0 || ran.exit_code == 4) << ran.exit_code << "\n" << ran.err;
  if (!loaded) {
    EXPECT_EQ(ran.exit_code, 0) << "self weight alone is always carried\n" << ran.err;
  }

  const Ran check = run({binary("skinframe"), "check", out}, scratch.path());
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
  const json report = json::parse(read_file(out / "report.json"));
  const json& printer = report.at("printers").at(0);
  if (ran.exit_code == 4) {
    EXPECT_GT(printer.at("best_reachable_displacement_mm").get<double>(), 0.05);
    EXPECT_NE(ran.err.find("mm"), std::string::npos) << ran.err;
    return;
  }
  EXPECT_EQ(printer.contains("verification"), loaded);
  if (loaded) {
    EXPECT_EQ(printer.at("verification").at("label"), "verified") << printer.at("verification");
  }
  EXPECT_EQ(printer.at("balance").get<std::string>(),
            report.at("mesh").at("stands").get<bool>() ? "holds" : "not_standing");
  if (printer.contains("supports")) {  // what the check re-computed; here its bound
    EXPECT_LE(printer["supports"]["overhang"]["beyond_share"].get<double>(), 0.02);
  }
  if (!body.thin_limbs) {
    EXPECT_LT(printer.at("ratio").get<double>(), 0.45);
  }
  if (!loaded) {
    // The skin alone carries its weight: internal struts are there only where balance needs their mass.
    const json frame = json::parse(read_file(out / setting.printer / "frame.json"));
    int internal = 0;
    for (const json& strut : frame.at("struts")) internal += strut.at("skin").get<bool>() ? 0 : 1;
    const bool balance_is_tight =
        printer.at("balance") == "holds" && printer.at("printed_balance_margin_mm").get<double>() < 1.0;
    if (!balance_is_tight) {
      EXPECT_EQ(internal, 0);
    }
  }
  const Ran slicer =
      run({"/usr/bin/prusa-slicer", "--info", out / setting.printer / "skin-frame.stl"}, scratch.path());
  EXPECT_NE(slicer.out.find("manifold = yes"), std::string::npos) << slicer.out << slicer.err;
}

const Setting kSettings[] = {{"sinterstation-hiq", "200"}, {"makerbot-replicator-2", "140"}};

std::string name_of(const testing::TestParamInfo<std::tuple<Body, Setting, bool>>& info) {
  std::string name = std::get<0>(info.param).name + "_" + std::get<1>(info.param).printer +
                     (std::get<2>(info.param) ? "_side_load" : "_own_weight");
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Samples, MainJob,
                         testing::Combine(testing::Values(Body{"hanging-ball"},
                                                          Body{"hanging-ball-small-base"}, Body{"ring"},
                                                          Body{"stool", false, true}, Body{"relief"},
                                                          Body{"egg"}, Body{"bracket"}),
                                          testing::ValuesIn(kSettings), testing::Bool()),
                         name_of);

INSTANTIATE_TEST_SUITE_P(Corpus, MainJob,
                         testing::Combine(testing::Values(Body{"spot_low", true}, Body{"fish", true},
                                                          Body{"goathead", true}, Body{"hand", true},
                                                          Body{"torus", true}, Body{"koala_low", true}),
                                          testing::ValuesIn(kSettings), testing::Bool()),
                         name_of);

}  // namespace
}  // namespace skinframe::integration
