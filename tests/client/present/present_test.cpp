// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/present/event_line.h"
#include "client/present/job_table.h"
#include "client/present/json.h"
#include "client/present/progress_display.h"
#include "client/present/words.h"
#include "tests/client/fake/fake_clock.h"

namespace skinframe::client {
namespace {

using testing::HasSubstr;
using testing::Not;

v1::JobEvent size_event(int iteration) {
  v1::JobEvent event;
  event.set_sequence(17);
  event.mutable_time()->set_seconds(1795321867);
  event.mutable_time()->set_nanos(120'000'000);
  auto* p = event.mutable_progress();
  p->set_printer_id("sinterstation-hiq");
  p->set_stage("size");
  p->set_iteration(iteration);
  p->set_total_volume_mm3(94750.4);
  p->set_ratio(0.1163);
  p->set_struts_left(884);
  return event;
}

TEST(EventLine, ProgressTellsStageIterationVolumeRatioAndStruts) {
  EXPECT_EQ(event_line(size_event(3)),
            "    17  2026-11-22T04:31:07.120Z  sinterstation-hiq  size  iteration 3  total 94750 mm3  ratio "
            "11.6 %  "
            "884 struts");
}

TEST(EventLine, WhatIsNotKnownIsLeftOut) {
  v1::JobProgress progress;
  progress.set_stage("read");
  EXPECT_EQ(progress_text(progress), "read");
}

TEST(EventLine, StatesTellReasonDetailAndAttempt) {
  v1::JobEvent event;
  event.mutable_state()->set_state(v1::JOB_STATE_RUNNING);
  event.mutable_state()->set_attempt(2);
  EXPECT_EQ(event_text(event), "RUNNING (attempt 2)");
  event.mutable_state()->set_state(v1::JOB_STATE_FAILED);
  event.mutable_state()->set_reason(v1::REASON_INFEASIBLE);
  event.mutable_state()->set_detail("the head sinks");
  EXPECT_EQ(event_text(event), "FAILED, INFEASIBLE: the head sinks");
  event.mutable_state()->set_state(v1::JOB_STATE_CANCELLED);
  event.mutable_state()->set_reason(v1::REASON_CANCELLED);
  event.mutable_state()->clear_detail();
  EXPECT_EQ(event_text(event), "CANCELLED");
}

TEST(EventLine, AnInfeasiblePrinterTellsTheBestReachableDisplacementAndWhoseModelItIs) {
  v1::JobEvent event;
  auto* printer = event.mutable_printer();
  printer->set_printer_id("p");
  printer->set_state(v1::JOB_STATE_FAILED);
  printer->set_reason(v1::REASON_INFEASIBLE);
  printer->set_best_reachable_displacement_mm(0.0821);
  EXPECT_THAT(event_text(event), HasSubstr("best reachable displacement 0.082 mm (paper model)"));
}

TEST(Words, AStrangersTextCannotControlTheTerminal) {
  EXPECT_EQ(one_line("a\x1b[2J\nb\x7f"), "a [2J b ");
  EXPECT_EQ(one_line("x\xc2\x9bz"), "x  z");
  EXPECT_EQ(one_line("caf\xc3\xa9"), "caf\xc3\xa9");
}

TEST(ProgressBar, FillsByStageAndNeverWraps) {
  EXPECT_THAT(progress_bar(size_event(3).progress(), 200), HasSubstr("[#########.......] "));
  EXPECT_EQ(progress_bar(size_event(3).progress(), 40).size(), 39u);
}

class Display : public testing::Test {
 protected:
  std::string shown() {
    std::fflush(file_);
    std::rewind(file_);
    std::string out(10'000, '\0');
    out.resize(std::fread(out.data(), 1, out.size(), file_));
    return out;
  }
  void TearDown() override { std::fclose(file_); }
  std::FILE* file_ = std::tmpfile();
  fake::FakeClock clock_;
};

TEST_F(Display, WithoutATerminalALineComesWhenTheStageChangesAndEveryTwoSeconds) {
  ProgressDisplay display(file_, false, clock_);
  display.show(size_event(1));
  display.show(size_event(2));
  clock_.advance(std::chrono::milliseconds(2100));
  display.show(size_event(3));
  auto topology = size_event(1);
  topology.mutable_progress()->set_stage("topology");
  display.show(topology);
  const std::string text = shown();
  EXPECT_THAT(text, HasSubstr("size  iteration 1"));
  EXPECT_THAT(text, Not(HasSubstr("size  iteration 2")));
  EXPECT_THAT(text, HasSubstr("size  iteration 3"));
  EXPECT_THAT(text, HasSubstr("topology  iteration 1"));
}

TEST_F(Display, APrinterBesideAnotherDoesNotHurryItsLines) {
  ProgressDisplay display(file_, false, clock_);
  for (const int iteration : {1, 2, 3})
    for (const char* printer : {"one", "two"}) {
      auto event = size_event(iteration);
      event.mutable_progress()->set_printer_id(printer);
      display.show(event);
    }
  const std::string text = shown();
  EXPECT_THAT(text, HasSubstr("one  size  iteration 1"));
  EXPECT_THAT(text, HasSubstr("two  size  iteration 1"));
  EXPECT_THAT(text, Not(HasSubstr("iteration 2")));
}

TEST_F(Display, OnATerminalTheBarStaysInItsLineAndGoesAtTheEnd) {
  ProgressDisplay display(file_, true, clock_);
  display.show(size_event(1));
  display.show(size_event(2));
  display.finish();
  const std::string text = shown();
  EXPECT_THAT(text, Not(HasSubstr("\n")));
  EXPECT_THAT(text, testing::EndsWith("\r\x1b[K"));
}

v1::Job finished_job() {
  v1::Job job;
  job.set_job_id("j1");
  job.set_state(v1::JOB_STATE_SUCCEEDED);
  job.set_reason(v1::REASON_PARTIAL);
  auto* good = job.add_printers();
  good->set_printer_id("sinterstation-hiq");
  good->set_material_id("pa");
  good->set_state(v1::JOB_STATE_SUCCEEDED);
  auto* s = good->mutable_statistics();
  s->set_nodes(266);
  s->set_struts(770);
  s->set_skin_volume_mm3(66000);
  s->set_frame_volume_mm3(28750);
  s->set_total_volume_mm3(94750);
  s->set_solid_volume_mm3(816810);
  s->set_ratio(0.116);
  s->set_printed_volume_mm3(80000);
  s->set_weight_g(109.3);
  s->set_max_displacement_mm(0.05);
  auto* verified = s->mutable_verified();
  verified->set_max_displacement_mm(1.5);
  verified->set_hollow_max_displacement_mm(0.9);
  verified->set_pinch_max_mm(0.25);
  verified->set_verdict("worse in everything");
  auto* bad = job.add_printers();
  bad->set_printer_id("makerbot-replicator-2");
  bad->set_state(v1::JOB_STATE_FAILED);
  bad->set_reason(v1::REASON_DOES_NOT_FIT);
  bad->set_detail("50 mm too tall");
  return job;
}

TEST(ResultTable, HasTheFiguresOfTable2AndNamesTheModelOfTheDisplacement) {
  const std::string table = result_table(finished_job());
  for (const char* figure : {"266/770", "66000", "28750", "94750", "816810", "11.6 %", "80000", "109.3 g",
                             "0.0500 mm", "paper's model"}) {
    EXPECT_THAT(table, HasSubstr(figure));
  }
  EXPECT_THAT(table, Not(HasSubstr("makerbot")));
  v1::JobEvent event;
  *event.mutable_printer() = finished_job().printers(0);
  EXPECT_THAT(event_text(event), HasSubstr("displacement 0.0500 mm (paper model), 1.5000 mm (verified)"));
  event.mutable_printer()->mutable_statistics()->clear_verified();
  EXPECT_THAT(event_text(event), HasSubstr("displacement 0.0500 mm (paper model), not verified"));
  EXPECT_THAT(end_report(finished_job()),
              HasSubstr("makerbot-replicator-2: FAILED, DOES_NOT_FIT: 50 mm too tall"));
}

TEST(ResultTable, SetsTheVerifiedFiguresAndTheHollowsBesideThoseOfThePaper) {
  const std::string table = result_table(finished_job());
  for (const char* figure : {"verified", "1.5000 mm", "0.9000 mm", "0.2500 mm", "worse in everything"})
    EXPECT_THAT(table, HasSubstr(figure));
  v1::Job job = finished_job();
  job.mutable_printers(0)->mutable_statistics()->clear_verified();
  job.mutable_spec()->mutable_options()->set_verify(v1::VERIFY_OFF);
  EXPECT_THAT(result_table(job), HasSubstr("not verified; the paper's model alone speaks for it"));
  job.mutable_printers(0)->mutable_statistics()->set_not_verified("it falls apart");
  EXPECT_THAT(result_table(job), HasSubstr("not verified: it falls apart"));
  EXPECT_THAT(result_table(job), Not(HasSubstr("1.5000")));
}

v1::Job solved_frame() {
  v1::Job job;
  job.set_job_id("j2");
  job.set_state(v1::JOB_STATE_SUCCEEDED);
  job.mutable_spec()->set_frame_problem_sha256(std::string(64, 'a'));
  job.mutable_spec()->set_mesh_name("tower.json");
  auto& frame = *job.mutable_frame();
  frame.set_mechanics("axial");
  frame.set_max_displacement_mm(0.0499);
  frame.set_iterations(80);
  for (const auto& [name, volume, struts] :
       {std::tuple("initial", 15617.7, 1311), std::tuple("size", 16218.2, 1311),
        std::tuple("topology", 8109.1, 175)}) {
    auto& stage = *frame.add_stages();
    stage.set_stage(name);
    stage.set_frame_volume_mm3(volume);
    stage.set_nodes(200);
    stage.set_struts(struts);
  }
  return job;
}

TEST(ResultTable, OfAFrameProblemHasTheVolumeOfEachStage) {
  const std::string table = result_table(solved_frame());
  for (const char* figure :
       {"16218.2", "1311", "100.0 %", "8109.1", "175", "50.0 %", "0.0499 mm", "axial model"})
    EXPECT_THAT(table, HasSubstr(figure));
  EXPECT_THAT(table, Not(HasSubstr("best reachable")));
  v1::Job weak = solved_frame();
  weak.mutable_frame()->clear_max_displacement_mm();
  weak.mutable_frame()->set_best_reachable_displacement_mm(0.0712);
  EXPECT_THAT(result_table(weak), HasSubstr("best reachable displacement 0.0712 mm"));
  EXPECT_THAT(result_table(weak), HasSubstr("displacement -,"));
}

TEST(JobDescription, OfAFrameProblemNamesItsFileAndNoPrinter) {
  const std::string text = job_description(solved_frame());
  EXPECT_THAT(text, testing::ContainsRegex("problem +tower.json"));
  EXPECT_THAT(text, Not(HasSubstr("printers")));
  EXPECT_THAT(job_list({solved_frame()}), HasSubstr("(frame problem)"));
  v1::Job warm = finished_job();
  warm.mutable_spec()->set_warm_start_job_id("j0");
  EXPECT_THAT(job_description(warm), testing::ContainsRegex("starts from +j0"));
}

TEST(Json, NumbersAreNumbersEnumsAreWordsAndAbsentIsLeftOut) {
  v1::JobEvent event = size_event(3);
  const auto json = to_json(event);
  EXPECT_EQ(json["sequence"], 17);
  EXPECT_EQ(json["time"], "2026-11-22T04:31:07.120Z");
  EXPECT_EQ(json["progress"]["stage"], "size");
  EXPECT_EQ(json["progress"]["ratio"], 0.1163);
  EXPECT_FALSE(json["progress"].contains("violation"));
  EXPECT_FALSE(json.contains("state"));
  v1::Job job = finished_job();
  (*job.mutable_spec()->mutable_labels())["order"] = "4711";
  job.mutable_spec()->mutable_deadline()->set_seconds(90);
  const auto described = to_json(job);
  EXPECT_EQ(described["state"], "SUCCEEDED");
  EXPECT_EQ(described["reason"], "PARTIAL");
  EXPECT_EQ(described["printers"][0]["reason"], "NONE");
  EXPECT_EQ(described["spec"]["labels"]["order"], "4711");
  EXPECT_EQ(described["spec"]["deadline"], 90.0);
  EXPECT_TRUE(described["files"].is_array());
}

}  // namespace
}  // namespace skinframe::client
