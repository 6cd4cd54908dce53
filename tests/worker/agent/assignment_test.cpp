// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/assignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace skinframe::agent {
namespace {

using nlohmann::json;

v1::Assignment minimal() {
  v1::Assignment a;
  a.set_job_id("j1");
  a.mutable_spec()->set_mesh_sha256(std::string(64, 'a'));
  a.mutable_spec()->set_mesh_name("fish.obj");
  a.mutable_spec()->add_printers()->set_printer_id("sinterstation-hiq");
  auto* printer = a.add_printers();
  printer->set_id("sinterstation-hiq");
  printer->set_process(v1::PRINT_PROCESS_POWDER);
  printer->set_min_radius_mm(0.5);
  printer->set_tray_x_mm(457);
  printer->set_tray_y_mm(380);
  printer->set_tray_z_mm(330);
  printer->set_max_internal_radius_mm(5);
  auto* material = a.add_materials();
  material->set_id("pa");
  material->set_tensile_modulus_mpa(1586);
  material->set_tensile_strength_mpa(43);
  return a;
}

json translated(const v1::Assignment& a) {
  const auto text = job_request_json(a, "/w/mesh", {}, 2);
  EXPECT_TRUE(text.ok()) << text.error().message;
  return text.ok() ? json::parse(*text) : json();
}

TEST(AssignmentTranslation, WhatTheApiLeavesOpenIsSpelledOut) {
  const json j = translated(minimal());
  EXPECT_EQ(j["job_id"], "j1");
  EXPECT_EQ(j["mesh_path"], "/w/mesh");
  EXPECT_EQ(j["threads"], 2);
  EXPECT_EQ(j["options"]["up"], "z");
  EXPECT_EQ(j["options"]["balance"], "auto");
  EXPECT_EQ(j["options"]["order"], "tight");
  EXPECT_EQ(j["options"]["verify"], true);
  EXPECT_EQ(j["options"]["displacement_limit_mm"], 0.05);
  EXPECT_EQ(j["options"]["seed"], 1);
  for (const char* open : {"size_mm", "skin_nodes", "internal_nodes", "voxel_mm"}) {
    EXPECT_TRUE(j["options"].at(open).is_null()) << open;
  }
  auto paper_alone = minimal();
  paper_alone.mutable_spec()->mutable_options()->set_verify(v1::VERIFY_OFF);
  EXPECT_EQ(translated(paper_alone)["options"]["verify"], false);
}

TEST(AssignmentTranslation, ProfilesKeepTheirFiguresAndAnAbsentLimitIsNull) {
  const json p = translated(minimal())["printers"][0];
  EXPECT_EQ(p["printer"]["process"], "powder");
  EXPECT_EQ(p["printer"]["tray_mm"], (json{457.0, 380.0, 330.0}));
  EXPECT_EQ(p["material"]["tensile_strength_mpa"], 43.0);
  EXPECT_TRUE(p["material"]["shear_strength_mpa"].is_null());
  EXPECT_TRUE(p["material"]["slenderness"].is_null());
}

TEST(AssignmentTranslation, WhatThePrinterPrintsWithoutSupportIsHandedOn) {
  const json absent = translated(minimal())["printers"][0]["printer"];
  EXPECT_TRUE(absent.at("printable_length").is_null());
  EXPECT_TRUE(absent.at("drain_holes").is_null());
  EXPECT_TRUE(absent.at("neck_diameter_mm").is_null());
  EXPECT_EQ(absent["build_direction"], "up");

  auto a = minimal();
  auto* printer = a.mutable_printers(0);
  auto* curve = printer->mutable_printable_length();
  curve->add_points()->set_angle_deg(45);
  curve->add_points()->set_angle_deg(90);
  curve->mutable_points(1)->set_length_mm(10);
  curve->set_is_default(true);
  curve->set_source("an assumption");
  printer->mutable_drain_holes()->set_diameter_mm(20);
  printer->mutable_drain_holes()->set_least_count(2);
  printer->mutable_drain_holes()->set_least_diameter_mm(3.5);
  printer->set_build_direction(v1::BUILD_DIRECTION_HANGING);
  printer->set_neck_diameter_mm(0.8);
  const json p = translated(a)["printers"][0]["printer"];
  EXPECT_EQ(p["printable_length"], json::parse(R"({"points": [{"angle_deg": 45.0, "length_mm": null},
    {"angle_deg": 90.0, "length_mm": 10.0}], "is_default": true, "source": "an assumption"})"));
  EXPECT_EQ(p["drain_holes"],
            json::parse(R"({"diameter_mm": 20.0, "least_count": 2, "least_diameter_mm": 3.5})"));
  EXPECT_EQ(p["build_direction"], "hanging");
  EXPECT_EQ(p["neck_diameter_mm"], 0.8);
}

TEST(AssignmentTranslation, ALoadActsAtAPlaceOrAtAPointNeverBoth) {
  auto a = minimal();
  auto* side = a.mutable_spec()->add_loads();
  side->set_name("side");
  side->set_place(v1::PLACE_TOP);
  side->mutable_force_n()->set_x(20);
  auto* pinch = a.mutable_spec()->add_loads();
  pinch->set_name("pinch");
  pinch->mutable_point_mm()->set_z(120);
  pinch->set_radius_mm(8);
  const json loads = translated(a)["loads"];
  EXPECT_EQ(loads[0]["place"], "top");
  EXPECT_TRUE(loads[0]["point_mm"].is_null());
  EXPECT_EQ(loads[0]["force_n"], (json{20.0, 0.0, 0.0}));
  EXPECT_EQ(loads[0]["radius_mm"], 5.0);
  EXPECT_TRUE(loads[1]["place"].is_null());
  EXPECT_EQ(loads[1]["point_mm"], (json{0.0, 0.0, 120.0}));
  EXPECT_EQ(loads[1]["radius_mm"], 8.0);
}

TEST(AssignmentTranslation, AFrameProblemIsItsFileAndNothingElse) {
  v1::Assignment a;
  a.set_job_id("j1");
  a.mutable_spec()->set_frame_problem_sha256(std::string(64, 'b'));
  a.mutable_spec()->set_mesh_name("frame.json");
  EXPECT_EQ(input_sha256(a.spec()), std::string(64, 'b'));
  EXPECT_EQ(translated(a), json::parse(R"({"job_id": "j1", "frame_problem_path": "/w/mesh",
                                           "mesh_name": "frame.json", "threads": 2})"));
}

TEST(AssignmentTranslation, OfTheEarlierJobsFilesTheInitialFramesAreTakenByPrinter) {
  auto warm = minimal();
  warm.mutable_spec()->set_warm_start_job_id("j0");
  for (const char* path :
       {"report.json", "sinterstation-hiq/frame.json", "sinterstation-hiq/initial-frame.json"})
    warm.add_warm_start_files()->set_path(path);
  const auto chosen = choose_warm_start_files(warm);
  ASSERT_EQ(chosen.size(), 1u);
  EXPECT_EQ(chosen.begin()->first, "sinterstation-hiq");
  const auto text = job_request_json(warm, "/w/mesh", {{"sinterstation-hiq", "/w/warm-start/0.json"}}, 1);
  ASSERT_TRUE(text.ok());
  EXPECT_EQ(json::parse(*text)["warm_start"],
            json::parse(R"({"job_id": "j0", "files": {"sinterstation-hiq": "/w/warm-start/0.json"}})"));
  EXPECT_FALSE(translated(minimal()).contains("warm_start"));
}

TEST(AssignmentTranslation, WhatIsNeitherMeshNorFrameProblemIsRefused) {
  auto neither = minimal();
  neither.mutable_spec()->clear_input();
  EXPECT_EQ(job_request_json(neither, "/w/mesh", {}, 1).error().kind, ErrorKind::kUnsupported);
}

TEST(AssignmentTranslation, AServerThatBreaksTheProtocolIsTold) {
  auto unequal = minimal();
  unequal.add_printers();
  EXPECT_EQ(job_request_json(unequal, "/w/mesh", {}, 1).error().kind, ErrorKind::kInternal);
  auto unknown = minimal();
  unknown.mutable_spec()->mutable_options()->set_up(static_cast<v1::Axis>(9));
  EXPECT_EQ(job_request_json(unknown, "/w/mesh", {}, 1).error().kind, ErrorKind::kInternal);
  unknown = minimal();
  unknown.mutable_spec()->mutable_options()->set_verify(static_cast<v1::Verify>(9));
  EXPECT_EQ(job_request_json(unknown, "/w/mesh", {}, 1).error().kind, ErrorKind::kInternal);
  auto nowhere = minimal();
  nowhere.mutable_spec()->add_loads()->set_name("side");
  EXPECT_EQ(job_request_json(nowhere, "/w/mesh", {}, 1).error().kind, ErrorKind::kInternal);
}

}  // namespace
}  // namespace skinframe::agent
