// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/worker/check/honest_result.h"

#include <fstream>

#include "worker/check/check.h"

namespace skinframe::check {

test::TemporaryFolder* CheckTest::folder_ = nullptr;

json read_json(const fs::path& path) {
  std::ifstream in(path);
  return json::parse(in);
}

void write_json(const fs::path& path, const json& document) { std::ofstream(path) << document; }

void CheckTest::SetUpTestSuite() {
  folder_ = new test::TemporaryFolder;
  JobRequest request = test::sample_job("egg", 36, 60, folder_->path());
  request.loads = {{"side", Place::kTop, {1, 0, 0}, 5}};
  request.options.verify = true;
  RunContext context;
  auto outcomes = run_pipeline(request, honest(), PipelineObserver{}, context);
  ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
  ASSERT_TRUE(outcomes->front().succeeded()) << outcomes->front().detail;
}

void CheckTest::TearDownTestSuite() {
  delete folder_;
  folder_ = nullptr;
}

std::vector<std::string> CheckTest::denied(const std::function<void(const fs::path&)>& spoil,
                                           const fs::path& from) {
  const fs::path copy = folder_->path() / "copy";
  fs::remove_all(copy);
  fs::copy(from, copy, fs::copy_options::recursive);
  spoil(copy);
  RunContext context;
  auto verdicts = check_directory(copy, context);
  if (!verdicts.ok()) return {"error: " + verdicts.error().message};
  std::vector<std::string> names;
  for (const Verdict& verdict : *verdicts)
    for (const Claim& claim : verdict.claims)
      if (!claim.holds) names.push_back(claim.name);
  return names;
}

std::vector<std::string> CheckTest::denied_report(const std::function<void(json&)>& lie,
                                                  const fs::path& from) {
  return denied(
      [&](const fs::path& copy) {
        json report = read_json(copy / "report.json");
        lie(report["printers"][0]);
        write_json(copy / "report.json", report);
      },
      from);
}

std::vector<std::string> CheckTest::denied_frame(const std::function<void(json&)>& lie) {
  return denied([&](const fs::path& copy) {
    json frame = read_json(copy / kPrinter / "frame.json");
    lie(frame);
    write_json(copy / kPrinter / "frame.json", frame);
  });
}

}  // namespace skinframe::check
