// SPDX-License-Identifier: Apache-2.0
// Every bound of job.proto: the last good value passes, the next is refused by the name of its field.
#include "server/api/spec_validation.h"

#include <google/protobuf/unknown_field_set.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "server/api/spec_digest.h"

namespace skinframe::server {
namespace {

v1::JobSpec good() {
  v1::JobSpec spec;
  spec.set_mesh_sha256(std::string(64, 'a'));
  spec.add_printers()->set_printer_id("sinterstation-hiq");
  return spec;
}

v1::Load good_load() {
  v1::Load load;
  load.set_name("side");
  load.set_place(v1::PLACE_TOP);
  load.mutable_force_n()->set_x(20);
  return load;
}

absl::Status validate(const std::function<void(v1::JobSpec&)>& change) {
  v1::JobSpec spec = good();
  change(spec);
  return validate_spec(spec, built_in_catalog());
}

std::string numbered_label(int i) { return std::string("l").append(std::to_string(i)); }

void expect_good(const std::function<void(v1::JobSpec&)>& change) {
  const absl::Status status = validate(change);
  EXPECT_TRUE(status.ok()) << status;
}

void expect_refused(const std::function<void(v1::JobSpec&)>& change, const std::string& names,
                    absl::StatusCode code = absl::StatusCode::kInvalidArgument) {
  const absl::Status status = validate(change);
  EXPECT_EQ(status.code(), code) << status;
  EXPECT_NE(status.message().find(names), absl::string_view::npos) << status;
}

TEST(SpecValidation, TheSimplestSpecIsGood) {
  expect_good([](auto&) {});
}

TEST(SpecValidation, TheWholeIsBoundedWithFieldsOfVersionsToCome) {
  const auto grow = [](v1::JobSpec& spec, std::size_t bytes) {
    auto& unknown = *spec.GetReflection()->MutableUnknownFields(&spec);
    unknown.AddLengthDelimited(1000, std::string(bytes - 5 - spec.ByteSizeLong(), 'x'));  // tag 2, length 3
    ASSERT_EQ(spec.ByteSizeLong(), bytes);
  };
  expect_good([&](auto& s) { grow(s, 65536); });
  expect_refused([&](auto& s) { grow(s, 65537); }, "spec has 65537 bytes, at most 65536 are allowed");
}

TEST(SpecValidation, AnUnknownPrinterIsAnsweredWithTheKnownOnes) {
  expect_refused([](auto& s) { s.mutable_printers(0)->set_printer_id("x"); },
                 "unknown printer \"x\"; known: bambu-x1-carbon, ");
  expect_refused([](auto& s) { s.mutable_printers(0)->set_material_id("x"); },
                 "unknown material \"x\"; known: abs, ");
}

TEST(SpecValidation, PrintersAreOneOrMoreAndNoneTwice) {
  expect_refused([](auto& s) { s.clear_printers(); }, "spec.printers");
  expect_good([](auto& s) { s.add_printers()->set_printer_id("makerbot-replicator-2"); });
  expect_refused([](auto& s) { s.add_printers()->set_printer_id("sinterstation-hiq"); }, "named twice");
}

TEST(SpecValidation, WhatAProfileDoesNotKnowAndAJobNeedsIsNamed) {
  expect_refused([](auto& s) { s.mutable_printers(0)->set_material_id("petg"); },
                 "material \"petg\": a job needs shear_modulus_mpa, which its profile does not know");
  expect_refused([](auto& s) { s.mutable_printers(0)->set_printer_id("prusa-sl1s"); },
                 "printer \"prusa-sl1s\" has no default material; name one: abs, ");
}

TEST(SpecValidation, TheInputIsAMeshByItsHash) {
  expect_refused([](auto& s) { s.clear_input(); }, "mesh_sha256");
  expect_refused([](auto& s) { s.set_mesh_sha256("abc"); }, "mesh_sha256");
  expect_refused([](auto& s) { s.set_mesh_name(std::string(256, 'x')); }, "mesh_name");
}

TEST(SpecValidation, AFrameProblemStandsAloneAndWhatStandsBesideItIsNamed) {
  const auto with = [](const std::function<void(v1::JobSpec&)>& change) {
    return [change](v1::JobSpec& spec) {
      spec.set_frame_problem_sha256(std::string(64, 'b'));
      spec.clear_printers();
      spec.mutable_options();  // there, but says nothing
      change(spec);
    };
  };
  expect_good(with([](auto&) {}));
  expect_good(with([](auto& s) { s.set_priority(3); }));
  expect_refused(with([](auto& s) { s.set_frame_problem_sha256("abc"); }), "spec.frame_problem_sha256");
  expect_refused(with([](auto& s) { s.add_printers()->set_printer_id("sinterstation-hiq"); }),
                 "spec.printers names \"sinterstation-hiq\"");
  expect_refused(with([](auto& s) { *s.add_loads() = good_load(); }), "spec.loads[0]");
  expect_refused(with([](auto& s) { s.mutable_options()->set_size_mm(200); }), "options.size_mm");
  expect_refused(with([](auto& s) { s.mutable_options()->set_no_optimize(true); }), "options.no_optimize");
  expect_refused(with([](auto& s) { s.set_warm_start_job_id("j"); }), "spec.warm_start_job_id");
  expect_refused(with([](auto& s) { s.set_priority(101); }), "spec.priority");
}

TEST(SpecValidation, AnIdToStartFromIsBounded) {
  expect_good([](auto& s) { s.set_warm_start_job_id(std::string(64, 'a')); });
  expect_refused([](auto& s) { s.set_warm_start_job_id(std::string(65, 'a')); }, "spec.warm_start_job_id");
}

TEST(SpecValidation, NumericOptionsHaveTheirDocumentedRanges) {
  using Set = std::function<void(v1::JobOptions&, double)>;
  struct Range {
    std::string field;
    double low, high;
    Set set;
  };
  const Range ranges[] = {
      {"size_mm", 1, 2000, [](auto& o, double v) { o.set_size_mm(v); }},
      {"skin_nodes", 12, 20000,
       [](auto& o, double v) { o.set_skin_nodes(static_cast<int>(std::lround(v))); }},
      {"internal_nodes", 0, 20000,
       [](auto& o, double v) { o.set_internal_nodes(static_cast<int>(std::lround(v))); }},
      {"voxel_mm", 0.02, 5, [](auto& o, double v) { o.set_voxel_mm(v); }},
      {"displacement_limit_mm", 0.001, 100, [](auto& o, double v) { o.set_displacement_limit_mm(v); }},
  };
  for (const Range& range : ranges) {
    const bool whole = range.field.ends_with("nodes");
    const double step = whole ? 1 : 1e-6;
    expect_good([&](auto& s) { range.set(*s.mutable_options(), range.low); });
    expect_good([&](auto& s) { range.set(*s.mutable_options(), range.high); });
    expect_refused([&](auto& s) { range.set(*s.mutable_options(), range.low - step); }, range.field);
    expect_refused([&](auto& s) { range.set(*s.mutable_options(), range.high + step); }, range.field);
    if (whole) continue;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_refused([&](auto& s) { range.set(*s.mutable_options(), nan); }, range.field);
  }
}

TEST(SpecValidation, EnumNumbersOutsideTheApiAreRefused) {
  expect_refused([](auto& s) { s.mutable_options()->set_up(static_cast<v1::Axis>(57)); }, "options.up");
  expect_refused([](auto& s) { s.mutable_options()->set_balance(static_cast<v1::Balance>(57)); },
                 "options.balance");
  expect_refused([](auto& s) { s.mutable_options()->set_verify(static_cast<v1::Verify>(57)); },
                 "options.verify");
  expect_refused([](auto& s) { s.mutable_options()->set_order(static_cast<v1::StageOrder>(57)); },
                 "options.order");
}

TEST(SpecValidation, LoadsAreNamedPlacedAndBounded) {
  const auto with_load = [](const std::function<void(v1::Load&)>& change) {
    return [change](v1::JobSpec& spec) {
      *spec.add_loads() = good_load();
      change(*spec.mutable_loads(0));
    };
  };
  expect_good(with_load([](auto&) {}));
  expect_good(with_load([](auto& l) { l.mutable_point_mm()->set_z(100); }));
  expect_refused(with_load([](auto& l) { l.set_name(""); }), "loads[0].name");
  expect_refused(with_load([](auto& l) { l.set_name("Side"); }), "loads[0].name");
  expect_refused(with_load([](auto& l) { l.set_name(std::string(33, 'a')); }), "loads[0].name");
  expect_refused(with_load([](auto& l) { l.clear_where(); }), "loads[0]");
  expect_refused(with_load([](auto& l) { l.set_place(v1::PLACE_UNSPECIFIED); }), "loads[0].place");
  expect_refused(with_load([](auto& l) { l.clear_force_n(); }), "loads[0].force_n");
  expect_refused(with_load([](auto& l) { l.mutable_force_n()->set_y(INFINITY); }), "loads[0].force_n");
  expect_good(with_load([](auto& l) { l.set_radius_mm(1000); }));
  expect_refused(with_load([](auto& l) { l.set_radius_mm(1000.1); }), "loads[0].radius_mm");
  expect_refused(with_load([](auto& l) { l.set_radius_mm(-1); }), "loads[0].radius_mm");
  expect_refused(
      [](auto& s) {
        for (int i = 0; i < 65; ++i) *s.add_loads() = good_load();
      },
      "spec.loads");
}

TEST(SpecValidation, LabelsPriorityAndDeadlineAreBounded) {
  expect_good([](auto& s) { (*s.mutable_labels())["farm.hall-3_b"] = "north"; });
  expect_refused([](auto& s) { (*s.mutable_labels())["Farm"] = "x"; }, "Farm");
  expect_refused([](auto& s) { (*s.mutable_labels())["farm"] = std::string(256, 'x'); }, "farm");
  expect_refused(
      [](auto& s) {
        for (int i = 0; i < 17; ++i) (*s.mutable_labels())[numbered_label(i)] = "";
      },
      "spec.labels");
  expect_good([](auto& s) { s.set_priority(100); });
  expect_refused([](auto& s) { s.set_priority(101); }, "priority");
  expect_refused([](auto& s) { s.set_priority(-101); }, "priority");
  expect_refused([](auto& s) { s.mutable_deadline(); }, "deadline");
  expect_refused([](auto& s) { s.mutable_deadline()->set_seconds(-5); }, "deadline");
  expect_refused([](auto& s) { s.mutable_deadline()->set_seconds(std::numeric_limits<std::int64_t>::max()); },
                 "deadline");
  expect_good([](auto& s) { s.mutable_deadline()->set_seconds(60); });
}

TEST(SpecValidation, RequestIdsAreShortAndPlain) {
  EXPECT_TRUE(validate_request_id("").ok());
  EXPECT_TRUE(validate_request_id("Farm-1_a.b").ok());
  EXPECT_FALSE(validate_request_id("a b").ok());
  EXPECT_FALSE(validate_request_id(std::string(65, 'a')).ok());
}

TEST(SpecDigest, DependsOnTheContentNotOnTheOrderOfLabels) {
  v1::JobSpec one = good();
  v1::JobSpec two = good();
  for (int i = 0; i < 16; ++i) (*one.mutable_labels())[numbered_label(i)] = "x";
  for (int i = 15; i >= 0; --i) (*two.mutable_labels())[numbered_label(i)] = "x";
  EXPECT_EQ(digest_of(one), digest_of(two));
  two.set_priority(1);
  EXPECT_NE(digest_of(one), digest_of(two));
}

}  // namespace
}  // namespace skinframe::server
