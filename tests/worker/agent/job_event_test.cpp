// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/job_event.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace skinframe::agent {
namespace {

TEST(EventLine, ProgressCarriesWhatIsKnownAndLeavesOutTheRest) {
  const auto line = parse_event_line(
      R"({"progress": {"printer": "p-1", "stage": "size", "iteration": 3, "total_volume_mm3": 94750.5, "struts_left": 884}})");
  ASSERT_TRUE(line.ok());
  const auto& progress = std::get<v1::JobProgress>(*line);
  EXPECT_EQ(progress.printer_id(), "p-1");
  EXPECT_EQ(progress.stage(), "size");
  EXPECT_EQ(progress.iteration(), 3);
  EXPECT_DOUBLE_EQ(progress.total_volume_mm3(), 94750.5);
  EXPECT_EQ(progress.struts_left(), 884);
  EXPECT_FALSE(progress.has_ratio());
  EXPECT_FALSE(progress.has_violation());
}

TEST(EventLine, APrinterCarriesItsReasonAndStatistics) {
  const auto line = parse_event_line(
      R"({"printer": {"printer": "p-1", "material": "pa", "state": "FAILED", "reason": "INFEASIBLE", "detail": "too weak",
          "best_reachable_displacement_mm": 0.07, "statistics": {"nodes": 380, "ratio": 0.116, "balance": "holds",
            "verified": {"max_displacement_mm": 1.5, "pinch_max_mm": 0.25, "verdict": "even"},
            "not_verified": "never both"}}})");
  ASSERT_TRUE(line.ok());
  const auto& printer = std::get<v1::PrinterResult>(*line);
  EXPECT_EQ(printer.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(printer.reason(), v1::REASON_INFEASIBLE);
  EXPECT_DOUBLE_EQ(printer.best_reachable_displacement_mm(), 0.07);
  EXPECT_EQ(printer.statistics().nodes(), 380);
  EXPECT_EQ(printer.statistics().balance(), "holds");
  EXPECT_EQ(printer.statistics().verified().max_displacement_mm(), 1.5);
  EXPECT_EQ(printer.statistics().verified().pinch_max_mm(), 0.25);
  EXPECT_FALSE(printer.statistics().verified().has_hollow_max_displacement_mm());
  EXPECT_EQ(printer.statistics().verified().verdict(), "even");
  EXPECT_EQ(printer.statistics().not_verified(), "never both");
}

TEST(EventLine, ReasonNoneIsNoReason) {
  const auto line =
      parse_event_line(R"({"printer": {"printer": "p", "state": "SUCCEEDED", "reason": "NONE"}})");
  ASSERT_TRUE(line.ok());
  EXPECT_EQ(std::get<v1::PrinterResult>(*line).reason(), v1::REASON_UNSPECIFIED);
}

TEST(EventLine, AnUnfitLineIsAnErrorNeverACrash) {
  for (const char* bad :
       {"", "x", "[]", "3", "null", "{}", "{\"progress\": 3}", "{\"progress\": {}}",
        "{\"progress\": {\"stage\": 5}}", "{\"progress\": {\"stage\": \"size\", \"iteration\": -1}}",
        "{\"progress\": {\"stage\": \"size\", \"iteration\": 1.5}}",
        "{\"progress\": {\"stage\": \"size\", \"iteration\": 1e300}}",
        "{\"progress\": {\"stage\": \"size\", \"ratio\": 1e999}}",
        "{\"progress\": {\"stage\": \"size\", \"ratio\": \"0.1\"}}",
        "{\"progress\": {\"stage\": \"\xff\xfe\"}}", "{\"printer\": {\"state\": \"FAILED\"}}",
        "{\"printer\": {\"printer\": \"p\", \"state\": \"LOST\"}}",
        "{\"printer\": {\"printer\": \"p\", \"state\": \"FAILED\", \"reason\": \"BAD LUCK\"}}",
        "{\"printer\": {\"printer\": \"p\", \"state\": \"FAILED\", \"reason\": \"UNSPECIFIED\"}}"}) {
    EXPECT_FALSE(parse_event_line(bad).ok()) << bad;
  }
  EXPECT_FALSE(parse_event_line(std::string(60000, '[')).ok());
}

TEST(EventLine, ALongTextIsCutBetweenCharacters) {
  std::string text(kMaxDetailBytes - 1, 'a');
  text += "\xc3\xa9";  // é would be halved by the bound
  const auto line =
      parse_event_line(R"({"printer": {"printer": "p", "state": "FAILED", "detail": ")" + text + "\"}}");
  ASSERT_TRUE(line.ok());
  EXPECT_EQ(std::get<v1::PrinterResult>(*line).detail(), std::string(kMaxDetailBytes - 1, 'a'));
}

TEST(OutcomeFile, TellsStateReasonAndPrinters) {
  const auto outcome = parse_outcome(
      R"({"state": "SUCCEEDED", "reason": "PARTIAL", "detail": "one of two", "printers": [
          {"printer": "a", "material": "pa", "state": "SUCCEEDED", "reason": "NONE"},
          {"printer": "b", "material": "pla", "state": "FAILED", "reason": "DOES_NOT_FIT", "detail": "60 mm too tall"}]})");
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_EQ(outcome->state, v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(outcome->reason, v1::REASON_PARTIAL);
  ASSERT_EQ(outcome->printers.size(), 2u);
  EXPECT_EQ(outcome->printers[1].reason(), v1::REASON_DOES_NOT_FIT);
}

TEST(OutcomeFile, OnlyAnEndIsAnOutcome) {
  EXPECT_FALSE(parse_outcome(R"({"state": "RUNNING"})").ok());
  EXPECT_FALSE(parse_outcome(R"({"reason": "NONE"})").ok());
  EXPECT_FALSE(parse_outcome(R"({"state": "SUCCEEDED", "printers": 3})").ok());
  EXPECT_FALSE(parse_outcome("{\"state\": \"SUCC").ok());
}

TEST(OutcomeFile, AFramesResultKeepsItsStagesAndWhatIsNotKnownStaysAbsent) {
  const auto outcome =
      parse_outcome(R"({"state": "FAILED", "reason": "INFEASIBLE", "detail": "too weak", "printers": [],
      "frame": {"mechanics": "axial", "max_displacement_mm": null, "violated_constraint": "displacement",
                "best_reachable_displacement_mm": 0.07, "iterations": 31,
                "stages": [{"stage": "size", "frame_volume_mm3": 16.5, "nodes": 4, "struts": 6}]}})");
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  ASSERT_TRUE(outcome->frame);
  EXPECT_FALSE(outcome->frame->has_max_displacement_mm());
  EXPECT_FALSE(outcome->frame->has_lower_bound_mm3());
  EXPECT_DOUBLE_EQ(outcome->frame->best_reachable_displacement_mm(), 0.07);
  EXPECT_EQ(outcome->frame->violated_constraint(), "displacement");
  ASSERT_EQ(outcome->frame->stages_size(), 1);
  EXPECT_EQ(outcome->frame->stages(0).struts(), 6);
}

TEST(OutcomeFile, AFramesResultThatIsHostileIsRefusedByItsField) {
  for (const auto& [frame, names] : std::initializer_list<std::pair<const char*, const char*>>{
           {R"([])", "frame"},
           {R"({"stages": 3})", "stages"},
           {R"({"stages": [3]})", "frame.stages"},
           {R"({"stages": [{"nodes": -1}]})", "nodes"},
           {R"({"iterations": 1.5})", "iterations"},
           {R"({"max_axial_ratio": "x"})", "max_axial_ratio"},
           {R"({"stages": [{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}]})", "16"}}) {
    const auto outcome = parse_outcome(std::string(R"({"state": "SUCCEEDED", "frame": )") + frame + "}");
    ASSERT_FALSE(outcome.ok()) << frame;
    EXPECT_THAT(outcome.error().message, testing::HasSubstr(names));
  }
}

}  // namespace
}  // namespace skinframe::agent
