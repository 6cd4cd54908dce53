// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/read_job.h"

#include <gtest/gtest.h>

namespace skinframe {
namespace {

using nlohmann::json;

json valid_job() {
  return json::parse(R"({
    "job_id": "j1", "mesh_path": "/tmp/mesh", "mesh_name": "fish.obj",
    "printers": [{"printer": {"id": "p-1", "process": "powder", "min_radius_mm": 0.5, "tray_mm": [457, 380, 330],
                              "max_internal_radius_mm": 5},
                  "material": {"id": "pa", "tensile_modulus_mpa": 1586, "shear_modulus_mpa": 1387,
                               "tensile_strength_mpa": 43, "shear_strength_mpa": null, "slenderness": 60,
                               "density_g_cm3": 1.15, "price_per_kg": null}}],
    "loads": [{"name": "side", "place": "top", "point_mm": null, "force_n": [20, 0, 0], "radius_mm": 5}],
    "options": {"up": "y", "balance": "require", "size_mm": 200, "skin_nodes": null, "internal_nodes": 40,
                "voxel_mm": null, "smooth": "auto", "orient": "keep", "no_optimize": false, "verify": false, "order": "paper",
                "displacement_limit_mm": 0.05, "seed": 7},
    "threads": 2})");
}

TEST(ReadJob, EveryFieldArrives) {
  auto job = parse_job(valid_job());
  ASSERT_TRUE(job.ok()) << job.error().message;
  const JobRequest& request = job->request;
  EXPECT_EQ(request.printers[0].printer.tray_mm, Eigen::Vector3d(457, 380, 330));
  EXPECT_EQ(request.printers[0].material.tensile_strength_mpa, 43);
  EXPECT_FALSE(request.printers[0].material.shear_strength_mpa);
  EXPECT_EQ(std::get<Place>(request.loads[0].where), Place::kTop);
  EXPECT_EQ(request.options.up, Up::kY);
  EXPECT_EQ(request.options.balance, BalanceMode::kRequire);
  EXPECT_EQ(request.options.size_mm, 200);
  EXPECT_FALSE(request.options.skin_nodes);
  EXPECT_EQ(request.options.internal_nodes, 40);
  EXPECT_EQ(request.options.order, StageOrder::kPaper);
  EXPECT_EQ(request.options.seed, 7u);
  EXPECT_EQ(job->threads, 2);
}

TEST(ReadJob, WhatThePrinterPrintsWithoutSupportArrives) {
  json document = valid_job();
  document["printers"][0]["printer"].update(json::parse(R"({
    "printable_length": {"points": [{"angle_deg": 45, "length_mm": null}, {"angle_deg": 90, "length_mm": 10}],
                         "is_default": true, "source": "an assumption"},
    "drain_holes": {"diameter_mm": 20, "least_count": 2, "least_diameter_mm": 3.5}, "build_direction": "hanging", "neck_diameter_mm": 0.8})"));
  const auto job = parse_job(document);
  ASSERT_TRUE(job.ok()) << job.error().message;
  const PrinterProfile& printer = job->request.printers[0].printer;
  EXPECT_EQ(printer.printable_length->points()[1].length_mm, 10);
  EXPECT_TRUE(printer.printable_length->is_default());
  EXPECT_EQ(printer.printable_length->source(), "an assumption");
  EXPECT_EQ(printer.drain_holes->diameter_mm, 20);
  EXPECT_EQ(printer.drain_holes->least_count, 2);
  EXPECT_EQ(printer.drain_holes->least_diameter_mm, 3.5);
  EXPECT_EQ(printer.build_direction, BuildDirection::kHanging);
  EXPECT_EQ(printer.neck_diameter_mm, 0.8);

  const auto plain = parse_job(valid_job());
  EXPECT_FALSE(plain->request.printers[0].printer.printable_length);
  EXPECT_FALSE(plain->request.printers[0].printer.drain_holes);
}

TEST(ReadJob, ACurveThatDoesNotReachFlatStrutsIsRefused) {
  json document = valid_job();
  document["printers"][0]["printer"]["printable_length"] = json::parse(
      R"({"points": [{"angle_deg": 45, "length_mm": 20}], "is_default": false, "source": "measured"})");
  const auto job = parse_job(document);
  ASSERT_FALSE(job.ok());
  EXPECT_NE(job.error().message.find("printable_length"), std::string::npos) << job.error().message;
}

TEST(ReadJob, AFrameProblemIsItsFileAndAName) {
  const auto job = parse_job(json::parse(
      R"({"job_id": "j1", "frame_problem_path": "/w/problem.json", "mesh_name": "tower.json", "threads": 1})"));
  ASSERT_TRUE(job.ok()) << job.error().message;
  EXPECT_EQ(job->frame_problem, "/w/problem.json");
  EXPECT_EQ(job->request.mesh_name, "tower.json");
  EXPECT_FALSE(parse_job(valid_job())->frame_problem);
}

TEST(ReadJob, AnEarlierJobAndItsFilesArrive) {
  json document = valid_job();
  document["warm_start"] = {{"job_id", "j0"}, {"files", {{"p-1", "/w/warm-start/0.json"}}}};
  const auto job = parse_job(document);
  ASSERT_TRUE(job.ok()) << job.error().message;
  EXPECT_EQ(job->request.warm_start->job_id, "j0");
  EXPECT_EQ(job->request.warm_start->files.at("p-1"), "/w/warm-start/0.json");
  EXPECT_FALSE(parse_job(valid_job())->request.warm_start);
}

struct Spoiled {
  const char* what;
  json patch;
  const char* named;
};

TEST(ReadJob, EachWrongFieldIsRefusedByName) {
  const std::vector<Spoiled> cases = {
      {"printer id that climbs",
       {{"op", "replace"}, {"path", "/printers/0/printer/id"}, {"value", "../etc"}},
       "id"},
      {"radius of zero",
       {{"op", "replace"}, {"path", "/printers/0/printer/min_radius_mm"}, {"value", 0}},
       "min_radius_mm"},
      {"unknown process",
       {{"op", "replace"}, {"path", "/printers/0/printer/process"}, {"value", "clay"}},
       "process"},
      {"size below a millimetre",
       {{"op", "replace"}, {"path", "/options/size_mm"}, {"value", 0.5}},
       "size_mm"},
      {"nodes as text",
       {{"op", "replace"}, {"path", "/options/skin_nodes"}, {"value", "many"}},
       "skin_nodes"},
      {"force of two numbers",
       {{"op", "replace"}, {"path", "/loads/0/force_n"}, {"value", {1, 2}}},
       "force_n"},
      {"no printer", {{"op", "replace"}, {"path", "/printers"}, {"value", json::array()}}, "printers"},
      {"missing options", {{"op", "remove"}, {"path", "/options"}}, "options"},
  };
  for (const Spoiled& spoiled : cases) {
    auto job = parse_job(valid_job().patch(json::array({spoiled.patch})));
    ASSERT_FALSE(job.ok()) << spoiled.what;
    EXPECT_EQ(job.error().kind, ErrorKind::kInvalidInput) << spoiled.what;
    EXPECT_NE(job.error().message.find(spoiled.named), std::string::npos) << job.error().message;
  }
}

TEST(ReadJob, SmoothingIsTakenAsAsked) {
  json job = valid_job();
  EXPECT_EQ(parse_job(job)->request.options.smooth, Smooth::kAuto);
  job["options"]["smooth"] = "on";
  EXPECT_EQ(parse_job(job)->request.options.smooth, Smooth::kOn);
  job["options"]["smooth"] = "off";
  EXPECT_EQ(parse_job(job)->request.options.smooth, Smooth::kOff);
  job["options"]["smooth"] = "much";
  EXPECT_FALSE(parse_job(job).ok());
}

}  // namespace
}  // namespace skinframe
