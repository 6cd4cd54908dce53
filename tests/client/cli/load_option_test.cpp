// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/cli/job_arguments.h"

namespace skinframe::client {
namespace {

using testing::HasSubstr;

TEST(LoadOption, ANamedPlace) {
  const auto load = parse_load("side:top:20,0,-1.5");
  ASSERT_TRUE(load.ok()) << load.failure().message;
  EXPECT_EQ(load->name(), "side");
  EXPECT_EQ(load->place(), v1::PLACE_TOP);
  EXPECT_EQ(load->force_n().x(), 20);
  EXPECT_EQ(load->force_n().z(), -1.5);
  EXPECT_EQ(load->radius_mm(), 0);
}

TEST(LoadOption, APointAndARadius) {
  const auto load = parse_load("pinch-2:0,-30.5,8e1:0,10,0:4");
  ASSERT_TRUE(load.ok()) << load.failure().message;
  EXPECT_EQ(load->point_mm().y(), -30.5);
  EXPECT_EQ(load->point_mm().z(), 80);
  EXPECT_EQ(load->radius_mm(), 4);
}

TEST(LoadOption, WhatIsNotOfTheFormIsRefusedWithTheForm) {
  for (const char* bad : {"",
                          "side",
                          "side:top",
                          "side:top:20,0",
                          "side:top:20,0,0,0",
                          "side:top:a,b,c",
                          "side:top:20,0,0:",
                          "side:top:20,0,0:0",
                          "side:top:20,0,0:-1",
                          "side:top:20,0,0:1001",
                          "side:top:20,0,0:5:5",
                          "side:nowhere:1,2,3",
                          "side:TOP:1,2,3",
                          "Side:top:1,2,3",
                          ":top:1,2,3",
                          "side:top:nan,0,0",
                          "side:top:inf,0,0",
                          "side:top:1e999,0,0",
                          "side:top:0,0,0",
                          "side:top: 1,0,0",
                          "side:top:1,0,0x",
                          "side:1,2:1,0,0",
                          "a-name-of-more-than-thirty-two-letters:top:1,0,0"}) {
    const auto load = parse_load(bad);
    ASSERT_FALSE(load.ok()) << bad;
    EXPECT_EQ(load.failure().kind, FailureKind::kUsage);
    EXPECT_THAT(load.failure().message, HasSubstr("NAME:WHERE:FX,FY,FZ[:RADIUS]"));
  }
  EXPECT_THAT(parse_load("side:nowhere:1,2,3").failure().message, HasSubstr("\"nowhere\""));
}

TEST(LabelOption, SplitsAtTheFirstEqualsSign) {
  EXPECT_EQ(*parse_label("order=4711=a"), (std::pair<std::string, std::string>("order", "4711=a")));
  EXPECT_FALSE(parse_label("order").ok());
  EXPECT_FALSE(parse_label("=4711").ok());
}

TEST(DeadlineOption, TakesSecondsMinutesAndHours) {
  EXPECT_EQ(parse_deadline("90")->seconds(), 90);
  EXPECT_EQ(parse_deadline("90s")->seconds(), 90);
  EXPECT_EQ(parse_deadline("15m")->seconds(), 900);
  EXPECT_EQ(parse_deadline("1.5h")->seconds(), 5400);
  for (const char* bad : {"", "s", "0", "-5m", "5 m", "5d", "nan", "9999h"})
    EXPECT_FALSE(parse_deadline(bad).ok()) << bad;
}

TEST(JobArguments, OneMaterialServesAllPrintersAndSeveralEachTheirs) {
  JobArguments arguments;
  arguments.mesh = "models/fish.obj";
  arguments.printers = {"a", "b"};
  arguments.materials = {"pa"};
  const auto one = to_request(arguments);
  ASSERT_TRUE(one.ok());
  EXPECT_EQ(one->spec().printers(1).material_id(), "pa");
  EXPECT_EQ(one->spec().mesh_name(), "fish.obj");
  EXPECT_FALSE(one->spec().options().has_size_mm());
  arguments.materials = {"pa", "pla"};
  EXPECT_EQ(to_request(arguments)->spec().printers(1).material_id(), "pla");
  arguments.materials = {"pa", "pla", "abs"};
  EXPECT_EQ(to_request(arguments).failure().kind, FailureKind::kUsage);
}

}  // namespace
}  // namespace skinframe::client
