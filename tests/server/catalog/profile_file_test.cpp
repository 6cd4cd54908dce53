// SPDX-License-Identifier: Apache-2.0
#include "server/catalog/profile_file.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace skinframe::server {
namespace {

constexpr char kPrinter[] = R"({
  "printer": {
    "id": "mine",
    "display_name": "My printer",
    "process": "extrusion",
    "min_radius_mm": 0.4,
    "tray_x_mm": 200,
    "tray_y_mm": null,
    "printable_length": {
      "points": [
        {"angle_deg": 45, "length_mm": null},
        {"angle_deg": 60, "length_mm": 20},
        {"angle_deg": 90, "length_mm": 10}
      ],
      "is_default": false,
      "source": "measured on 2026-11-20"
    },
    "drain_holes": {"diameter_mm": 20, "least_count": 2, "least_diameter_mm": 3.5},
    "source": "its data sheet"
  }
})";

v1::PrinterProfile printer(const std::string& text) {
  const auto parsed = parse_profile(text, "mine.json");
  EXPECT_TRUE(parsed.ok()) << parsed.status();
  return parsed.ok() ? std::get<v1::PrinterProfile>(parsed->profile) : v1::PrinterProfile();
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const auto at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), by);
}

TEST(ProfileFile, EveryFieldArrivesAndNullIsAbsent) {
  const v1::PrinterProfile p = printer(kPrinter);
  EXPECT_EQ(p.id(), "mine");
  EXPECT_EQ(p.process(), v1::PRINT_PROCESS_EXTRUSION);
  EXPECT_EQ(p.tray_x_mm(), 200);
  EXPECT_FALSE(p.has_tray_y_mm());
  EXPECT_FALSE(p.has_tray_z_mm()) << "left out is as good as null";
  ASSERT_EQ(p.printable_length().points_size(), 3);
  EXPECT_FALSE(p.printable_length().points(0).has_length_mm());
  EXPECT_EQ(p.printable_length().points(2).length_mm(), 10);
  EXPECT_EQ(p.drain_holes().least_count(), 2);
  EXPECT_EQ(p.drain_holes().least_diameter_mm(), 3.5);
}

TEST(ProfileFile, AMaterialArrives) {
  const auto parsed = parse_profile(
      R"({"material": {"id": "m", "display_name": "M", "tensile_modulus_mpa": 2000, "density_g_cm3": 1.1,
          "sources": {"tensile_modulus_mpa": "its data sheet", "density_g_cm3": "weighed"}}})",
      "m.json");
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  const auto& m = std::get<v1::MaterialProfile>(parsed->profile);
  EXPECT_EQ(m.density_g_cm3(), 1.1);
  EXPECT_EQ(m.sources().at("density_g_cm3"), "weighed");
  EXPECT_FALSE(m.has_shear_modulus_mpa());
}

TEST(ProfileFile, AWordInCapitalsIsTheSameWord) {
  EXPECT_EQ(printer(replaced(kPrinter, "extrusion", "EXTRUSION")).process(), v1::PRINT_PROCESS_EXTRUSION);
}

struct Bad {
  const char* part;
  const char* by;
  const char* says;
};

TEST(ProfileFile, WhatIsWrongIsSaidWithFileLineAndField) {
  const Bad cases[] = {
      {"\"mine\"", "\"../mine\"", "mine.json:3: printer.id: \"../mine\""},
      {"\"My printer\"", "7", "mine.json:4: printer.display_name: is not a text"},
      {"\"extrusion\"", "\"clay\"", "mine.json:5: printer.process: is none of: powder, extrusion, resin"},
      {"0.4", "-0.4", "mine.json:6: printer.min_radius_mm: is -0.4, must be within 0.01 .. 50"},
      {"200", "\"200\"", "mine.json:7: printer.tray_x_mm: is not a number"},
      {"200", "1e999", "mine.json:7: not JSON"},
      {"\"tray_y_mm\"", "\"tray_q_mm\"", "mine.json:8: printer.tray_q_mm: unknown field; known: id, "},
      {"\"tray_y_mm\": null", "\"tray_x_mm\": 3", "mine.json:8: \"printer.tray_x_mm\" stands twice"},
      {"20}", "5}",
       "mine.json:13: printer.printable_length.points[2].length_mm: is longer than the 5 mm at 60"},
      {"60", "40", "mine.json:12: printer.printable_length.points[1].angle_deg: is 40, not above 45"},
      {"90", "89",
       "mine.json:13: printer.printable_length.points[2].angle_deg: is 89: nothing would be known"},
      {"false", "0", "mine.json:15: printer.printable_length.is_default: is neither true nor false"},
      {"\"measured on 2026-11-20\"", "null", "printer.printable_length.source: is missing"},
      {", \"least_count\": 2", "", "mine.json:18: printer.drain_holes.least_count: is missing"},
      {"\"least_count\": 2", "\"least_count\": 2.5",
       "mine.json:18: printer.drain_holes.least_count: is not a whole number"},
      {"3.5", "21", "mine.json:18: printer.drain_holes.least_diameter_mm: is 21, above diameter_mm"},
      {"\"source\": \"its data sheet\"", "\"source\": null",
       "mine.json:6: printer.min_radius_mm: has no source"},
      {"\"source\": \"its data sheet\"", "\"sources\": {\"min_radius\": \"x\"}",
       "mine.json:19: printer.sources.min_radius: is no field"},
      {"\"printer\"", "\"drucker\"", "mine.json:1: a profile file is"},
      {"\"its data sheet\"", "\"its data sheet", "mine.json:20: not JSON"},
  };
  for (const Bad& bad : cases) {
    const auto parsed = parse_profile(replaced(kPrinter, bad.part, bad.by), "mine.json");
    EXPECT_EQ(parsed.status().code(), absl::StatusCode::kInvalidArgument) << bad.by;
    EXPECT_NE(parsed.status().message().find(bad.says), absl::string_view::npos)
        << bad.says << "\n is not in\n"
        << parsed.status().message();
  }
}

TEST(ProfileFile, WhatACurveNeedsIsNotTakenForGranted) {
  const auto refused = [](const std::string& part, const std::string& by, const std::string& says) {
    const auto parsed = parse_profile(replaced(kPrinter, part, by), "mine.json");
    EXPECT_NE(parsed.status().message().find(says), absl::string_view::npos) << parsed.status();
  };
  refused("\"angle_deg\": 45, ", "", "printer.printable_length.points[0].angle_deg: is missing");
  refused("\"is_default\": false,", "", "mine.json:9: printer.printable_length.is_default: is missing");
}

// Every number of the format, told from catalog.proto: none is taken without a bound.
void expect_bounded(const google::protobuf::Descriptor& type, const std::string& before,
                    const std::string& after) {
  using google::protobuf::FieldDescriptor;
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    const std::string start = before + "\"" + field.name() + "\": ";
    if (field.is_map()) continue;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      expect_bounded(*field.message_type(), start + (field.is_repeated() ? "[{" : "{"),
                     (field.is_repeated() ? "}]" : "}") + after);
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
               field.cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
      const auto parsed = parse_profile(start + "-4711" + after, "f");
      EXPECT_NE(parsed.status().message().find(field.name() + ": is -4711, must be within"),
                absl::string_view::npos)
          << parsed.status();
    }
  }
}

TEST(ProfileFile, EveryNumberHasItsRange) {
  expect_bounded(*v1::PrinterProfile::descriptor(), "{\"printer\": {", "}}");
  expect_bounded(*v1::MaterialProfile::descriptor(), "{\"material\": {", "}}");
}

TEST(ProfileFile, ADamagedFileIsReadOrRefusedWithItsPlaceAndNothingElse) {
  std::mt19937 random(3);
  const std::string whole = kPrinter;
  const std::string pieces = "{}[]\",:0.-eE\\ nul\xff\n";
  for (int round = 0; round < 5000; ++round) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = pieces[random() % pieces.size()];
    damaged.resize(damaged.size() - (random() % 4 == 0 ? random() % damaged.size() : 0));
    const auto parsed = parse_profile(damaged, "mine.json");
    EXPECT_TRUE(parsed.ok() || std::string(parsed.status().message()).starts_with("mine.json:"))
        << parsed.status();
  }
}

TEST(ProfileFile, HostileSizesAndDepthsAreRefused) {
  EXPECT_FALSE(parse_profile(std::string(kLargestProfileBytes + 1, ' '), "f").ok());
  const std::string deep = "{\"printer\": " + std::string(50'000, '[') + std::string(50'000, ']') + "}";
  EXPECT_NE(parse_profile(deep, "f").status().message().find("nested too deeply"), absl::string_view::npos);
  EXPECT_FALSE(parse_profile("", "f").ok());
  EXPECT_FALSE(parse_profile("[]", "f").ok());
  EXPECT_FALSE(parse_profile(R"({"printer": 1})", "f").ok());
  EXPECT_FALSE(parse_profile(R"({"printer": {}, "material": {}})", "f").ok());
  EXPECT_FALSE(parse_profile("{\"printer\": {\"id\": \"\xff\"}}", "f").ok()) << "not UTF-8";
}

}  // namespace
}  // namespace skinframe::server
