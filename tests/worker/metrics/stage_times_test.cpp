// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/metrics/stage_times.h"

#include <gtest/gtest.h>

namespace skinframe {
namespace {

using std::chrono::seconds;

class StageTimesTest : public testing::Test {
 protected:
  struct Seen {
    double count = 0, sum = 0;
  };
  Seen figure(const std::string& family, const std::string& stage) const {
    for (const auto& of : metrics_.registry()->Collect())
      for (const auto& metric : of.metric)
        if (of.name == family && !metric.label.empty() && metric.label[0].value == stage)
          return of.type == prometheus::MetricType::Counter
                     ? Seen{metric.counter.value, 0}
                     : Seen{static_cast<double>(metric.histogram.sample_count), metric.histogram.sample_sum};
    return {};
  }
  void expect_stage(const std::string& stage, double count, double sum) const {
    const Seen seen = figure("skinframe_stage_seconds", stage);
    EXPECT_EQ(seen.count, count) << stage;
    EXPECT_DOUBLE_EQ(seen.sum, sum) << stage;
  }

  WorkerMetrics metrics_;
  StageTimes times_{metrics_};
  const StageTimes::TimePoint start_{};
};

TEST_F(StageTimesTest, AStageLastsUntilItsPrintersNextAndASharedOneUntilTheFirstPrinters) {
  times_.tell("", "read", 0, start_);
  times_.tell("", "repair", 0, start_ + seconds(1));
  times_.tell("a", "skin", 0, start_ + seconds(3));
  times_.tell("b", "skin", 0, start_ + seconds(4));
  times_.tell("a", "size", 0, start_ + seconds(8));
  times_.end(start_ + seconds(10));
  expect_stage("read", 1, 1);
  expect_stage("repair", 1, 2);
  expect_stage("skin", 2, 5 + 6);
  expect_stage("size", 1, 2);
  times_.end(start_ + seconds(20));
  expect_stage("size", 1, 2);
}

TEST_F(StageTimesTest, IterationsAreCountedOnceHoweverOftenTheyAreToldAndAnewInEachPass) {
  for (const int iteration : {1, 2, 2, 5, 1, 2}) times_.tell("a", "size", iteration, start_);
  times_.tell("b", "size", 3, start_);
  EXPECT_EQ(figure("skinframe_solver_iterations_total", "size").count, 5 + 1 + 3);
}

TEST_F(StageTimesTest, WordsOfAStrangerBecomeNoNewRows) {
  for (int i = 0; i < 1000; ++i) {
    const std::string word = std::to_string(i);  // as printer and as stage
    times_.tell(word, word, 1, start_);
  }
  times_.end(start_ + seconds(1));
  expect_stage("other", 64, 64);
}

}  // namespace
}  // namespace skinframe
