// SPDX-License-Identifier: GPL-3.0-or-later
// The disk fails while a printer's files are written and its frame is verified: the job ends with the disk's
// error, without figures of either.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <set>

#include "tests/worker/pipeline/small_job.h"

namespace skinframe {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrinter = "sinterstation-hiq";

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

JobRequest verified_egg(const fs::path& folder) {
  JobRequest request = test::sample_job("egg", 60, 60, folder);
  request.loads = {{"side", Place::kTop, {1, 0, 0}, 5}};
  request.options.verify = true;
  return request;
}

class FailedWrite : public testing::TestWithParam<int> {
 protected:
  Result<std::vector<PrinterOutcome>> run() {
    PipelineObserver observer;
    observer.printer_ended = [this](const PrinterOutcome&) { ended_ = true; };
    RunContext context;
    context.threads = GetParam();
    return run_pipeline(request_, out_, observer, context);
  }

  // Frames are written before; nothing of what failed, nor half a file.
  void expect_told_and_nothing_left(const Result<std::vector<PrinterOutcome>>& outcomes,
                                    const std::string& words) {
    ASSERT_FALSE(outcomes.ok());
    EXPECT_EQ(outcomes.error().kind, ErrorKind::kIo) << outcomes.error().message;
    EXPECT_THAT(outcomes.error().message, testing::HasSubstr(words));
    EXPECT_FALSE(ended_);
    EXPECT_FALSE(fs::exists(out_ / "report.json"));
    for (const std::string& name : files_in(out_ / kPrinter)) {
      EXPECT_THAT(name, testing::Not(testing::HasSubstr(".part")));
      EXPECT_THAT(name, testing::Not(testing::HasSubstr(".ply"))) << "a figure of the verification";
      EXPECT_NE(name, "skin-frame-compact.stl") << "it comes last";
    }
  }

  const test::TemporaryFolder folder_;
  const JobRequest request_ = verified_egg(folder_.path());
  const fs::path out_ = folder_.path() / "out";
  bool ended_ = false;  // of the printer, by a report
};

TEST_P(FailedWrite, APathThatIsTakenEndsTheJobWithTheDisksError) {
  fs::create_directories(out_ / kPrinter / "skin-frame.stl");
  expect_told_and_nothing_left(run(), "skin-frame.stl");
  EXPECT_THAT(files_in(out_ / kPrinter),
              testing::UnorderedElementsAre("frame.json", "initial-frame.json", "skin-frame.stl"));
}

// The file size limit of the process stands for a full disk: the same path from write() to the status.
TEST_P(FailedWrite, AFullDiskEndsTheJobWithTheDisksError) {
  constexpr rlim_t kBytes = 400'000;  // frame.json is smaller, the printable mesh larger
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{kBytes, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto outcomes = run();
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old_handler);
  expect_told_and_nothing_left(outcomes, "skin-frame.stl: File too large");
}

INSTANTIATE_TEST_SUITE_P(Threads, FailedWrite, testing::Values(1, 2));

}  // namespace
}  // namespace skinframe
