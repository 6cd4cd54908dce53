// SPDX-License-Identifier: Apache-2.0
#include "client/present/profile_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skinframe::client {
namespace {

using testing::HasSubstr;
using testing::Not;

v1::PrinterProfile printer() {
  v1::PrinterProfile p;
  p.set_id("mine");
  p.set_display_name("My printer");
  p.set_process(v1::PRINT_PROCESS_EXTRUSION);
  p.set_min_radius_mm(0.4);
  p.set_tray_x_mm(200);
  p.set_tray_y_mm(180);
  p.set_source("its data sheet");
  (*p.mutable_sources())["min_radius_mm"] = "measured";
  auto* curve = p.mutable_printable_length();
  curve->add_points()->set_angle_deg(45);
  auto* flat = curve->add_points();
  flat->set_angle_deg(90);
  flat->set_length_mm(10);
  curve->set_is_default(true);
  curve->set_source("an assumption");
  return p;
}

TEST(ProfileTable, WhatIsNotKnownIsADashForPeopleAndNullInJson) {
  v1::ListPrintersResponse all;
  *all.add_printers() = printer();
  EXPECT_THAT(printer_list(all), HasSubstr("200x180x-"));
  const auto file = profile_file(printer());
  EXPECT_TRUE(file["printer"].at("tray_z_mm").is_null());
  EXPECT_EQ(file["printer"]["tray_x_mm"], 200);
  EXPECT_EQ(file["printer"]["process"], "EXTRUSION");
}

TEST(ProfileTable, ASheetTellsEachNumbersSourceOnce) {
  const std::string sheet = profile_sheet(printer());
  EXPECT_THAT(sheet, HasSubstr("[1] measured\n[2] its data sheet\n[3] an assumption\n"));
  EXPECT_THAT(sheet, testing::ContainsRegex("min_radius_mm +0\\.4 +\\[1\\]"));
  EXPECT_THAT(sheet, testing::ContainsRegex("tray_y_mm +180 +\\[2\\]"));
  EXPECT_THAT(sheet, testing::ContainsRegex("tray_z_mm +-\n"));
}

TEST(ProfileTable, ASheetTellsADefaultCurveFromAMeasuredOne) {
  v1::PrinterProfile p = printer();
  EXPECT_THAT(profile_sheet(p), HasSubstr("a default, not measured"));
  EXPECT_THAT(profile_sheet(p), testing::ContainsRegex("45 degrees from the vertical +no limit"));
  p.mutable_printable_length()->set_is_default(false);
  EXPECT_THAT(profile_sheet(p), Not(HasSubstr("not measured")));
}

TEST(ProfileTable, AForeignTextStaysInItsLine) {
  v1::MaterialProfile m;
  m.set_id("m");
  m.set_display_name("a\nb\x1b[31m");
  EXPECT_THAT(profile_sheet(m), Not(HasSubstr("\x1b")));
  EXPECT_THAT(profile_sheet(m), HasSubstr("a b"));
}

}  // namespace
}  // namespace skinframe::client
