// SPDX-License-Identifier: Apache-2.0
// Every file of the corpus through the whole job, client to files, with radii at their bounds: what the
// manifest accepts gives files whose every claim is checked and which hold the manifest's volume; what it
// refuses leaves a sentence that names the defect, the documented exit code, and no file behind.
//
// The ordinary run scales every model to kOrdinarySizeMm, where a job takes seconds; volumes are compared at
// that scale. SKINFRAME_CORPUS=full takes the manifest's own size (200 mm): half an hour on one core.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/fixture/corpus.h"
#include "tests/integration/process.h"

namespace skinframe::integration {
namespace {

using nlohmann::json;

constexpr double kOrdinarySizeMm = 60;
constexpr double kManifestSizeMm = 200;
constexpr Seconds kLongest{600};

bool full() {
  const char* asked = std::getenv("SKINFRAME_CORPUS");
  return asked != nullptr && std::string(asked) == "full";
}

class WholeJob : public testing::TestWithParam<std::string> {
 protected:
  const json& entry() const { return test::corpus().at(GetParam()); }
  bool has_own_size() const { return entry()["size_mm"].is_null(); }
  double size_mm() const { return full() ? entry()["size_mm"].get<double>() : kOrdinarySizeMm; }
  std::string out() const { return scratch_ / "result"; }

  Ran run_job() {
    std::vector<std::string> words = {binary("skinframe"),
                                      "run",
                                      test::corpus_folder() / entry()["file"].get<std::string>(),
                                      "--printer",
                                      "sinterstation-hiq",
                                      "--no-optimize",
                                      "--out",
                                      out()};
    if (!has_own_size()) words.insert(words.end(), {"--size", std::to_string(size_mm())});
    return run(words, scratch_.path(), kLongest);
  }

  void expect_refused(const Ran& ran) const {
    EXPECT_EQ(ran.exit_code, 3) << ran.err;
    EXPECT_NE(entry()["expected"], "accept");
    EXPECT_NE(entry()["expected"], "accept_after_repair");
    const auto words = test::corpus_refusals().find(GetParam());
    ASSERT_NE(words, test::corpus_refusals().end()) << "nothing says with what words: " << ran.err;
    for (const std::string& word : words->second)
      EXPECT_NE(ran.err.find(word), std::string::npos) << word << " is not in: " << ran.err;
    EXPECT_TRUE(!std::filesystem::exists(out()) || std::filesystem::is_empty(out()))
        << "files are left behind";
  }

  // Of the manifest, at the size of the job; none where an open or crossing surface has no volume of its own.
  std::optional<double> wanted_volume_mm3() const {
    const json& facts = entry()["facts"];
    if (!facts.value("watertight", false) || entry()["volume_tolerance"].is_null()) return std::nullopt;
    if (has_own_size()) return facts["volume_file_units"].get<double>();
    return facts["volume_200mm_mm3"].get<double>() * std::pow(size_mm() / kManifestSizeMm, 3);
  }

  void expect_accepted(const Ran& ran) {
    ASSERT_NE(entry()["expected"], "reject") << ran.out;
    const Ran check = run({binary("skinframe"), "check", out()}, scratch_.path());
    EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
    const json report = json::parse(read_file(std::filesystem::path(out()) / "report.json"));
    const json& printer = report.at("printers").at(0);
    const double solid = printer.at("solid_volume_mm3"), printed = printer.at("printed_volume_mm3");
    EXPECT_GT(printed, 0);
    EXPECT_LE(printed, solid * 1.0001);
    EXPECT_EQ(report.at("mesh").at("volume_mm3").get<double>(), solid);
    if (const auto wanted = wanted_volume_mm3()) {
      EXPECT_NEAR(solid / *wanted, 1, entry()["volume_tolerance"].get<double>());
    }
    if (entry()["expected"] == "accept_after_repair") {
      EXPECT_FALSE(report.at("mesh").at("repairs").empty());
    }
  }

  Scratch scratch_;
};

TEST_P(WholeJob, EndsAsTheManifestSays) {
  const Ran ran = run_job();
  if (ran.exit_code == 0) {
    expect_accepted(ran);
  } else {
    expect_refused(ran);
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, WholeJob, testing::ValuesIn(test::corpus_ids()),
                         [](const auto& tested) { return tested.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(WholeJob);

TEST(Corpus, IsThere) {
  EXPECT_FALSE(test::corpus().empty()) << "no manifest.json with models in " << test::corpus_folder();
}

}  // namespace
}  // namespace skinframe::integration
