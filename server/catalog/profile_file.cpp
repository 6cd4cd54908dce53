// SPDX-License-Identifier: Apache-2.0
#include "server/catalog/profile_file.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <vector>

#include "server/catalog/profile_message.h"
#include "server/lined_json/lined_json.h"

namespace skinframe::server {
namespace {

using google::protobuf::FieldDescriptor;
using nlohmann::json;

constexpr std::size_t kLongestId = 64;
constexpr int kMostPoints = 64;

bool is_id(const std::string& id) {
  return !id.empty() && id.size() <= kLongestId && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

template <class Profile>
absl::Status check_names(const ProfileReader& reader, const std::string& path, const Profile& profile) {
  if (!is_id(profile.id()))
    return reader.error(path + ".id",
                        fmt::format("\"{}\" is not 1 .. {} of a-z, 0-9 and -", profile.id(), kLongestId));
  if (profile.display_name().empty()) return reader.error(path + ".display_name", "is missing");
  return absl::OkStatus();
}

// A number that nobody can trace is worth no more than a guess.
template <class Profile>
absl::Status check_sources(const ProfileReader& reader, const std::string& path, const Profile& profile) {
  if (!profile.source().empty()) return absl::OkStatus();
  std::vector<const FieldDescriptor*> set;
  profile.GetReflection()->ListFields(profile, &set);
  for (const FieldDescriptor* field : set) {
    const bool is_number = field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE;
    if (!is_number && field->name() != "drain_holes") continue;
    const auto source = profile.sources().find(field->name());
    if (source == profile.sources().end() || source->second.empty())
      return reader.error(path + "." + field->name(),
                          fmt::format("has no source: say in sources.{} (or in source, for all) where the "
                                      "number comes from",
                                      field->name()));
  }
  return absl::OkStatus();
}

// The same rules as the worker's (worker/profile/printable_length.h), which has them from here again.
absl::Status check_curve(const ProfileReader& reader, const std::string& path,
                         const v1::PrintableLength& curve) {
  if (curve.points_size() < 1 || curve.points_size() > kMostPoints)
    return reader.error(path + ".points",
                        fmt::format("has {} points, must have 1 .. {}", curve.points_size(), kMostPoints));
  const v1::PrintableLength::Point* before = nullptr;
  for (int i = 0; i < curve.points_size(); ++i) {
    const auto& point = curve.points(i);
    const std::string here = fmt::format("{}.points[{}]", path, i);
    if (before != nullptr && !(point.angle_deg() > before->angle_deg()))
      return reader.error(here + ".angle_deg", fmt::format("is {:g}, not above {:g}, the one before",
                                                           point.angle_deg(), before->angle_deg()));
    const bool longer = before != nullptr && before->has_length_mm() &&
                        (!point.has_length_mm() || point.length_mm() > before->length_mm());
    if (longer)
      return reader.error(
          here + ".length_mm",
          fmt::format("is longer than the {:g} mm at {:g} degrees: a flatter strut never prints longer",
                      before->length_mm(), before->angle_deg()));
    before = &point;
  }
  if (before->angle_deg() != 90)
    return reader.error(
        fmt::format("{}.points[{}].angle_deg", path, curve.points_size() - 1),
        fmt::format("is {:g}: nothing would be known of flatter struts; the last point is that of one "
                    "that lies flat, at 90",
                    before->angle_deg()));
  if (curve.source().empty())
    return reader.error(path + ".source", "is missing: say what the points rest on");
  return absl::OkStatus();
}

absl::Status check_printer(const ProfileReader& reader, const v1::PrinterProfile& printer) {
  const std::string path = "printer";
  if (printer.process() == v1::PRINT_PROCESS_UNSPECIFIED)
    return reader.error(path + ".process", "is missing: powder, extrusion or resin");
  if (!printer.default_material_id().empty() && !is_id(printer.default_material_id()))
    return reader.error(path + ".default_material_id", "is not a material's id");
  if (printer.has_min_radius_mm() && printer.has_max_internal_radius_mm() &&
      printer.max_internal_radius_mm() < printer.min_radius_mm())
    return reader.error(path + ".max_internal_radius_mm",
                        fmt::format("is {:g}, below min_radius_mm", printer.max_internal_radius_mm()));
  const auto& holes = printer.drain_holes();
  if (holes.has_least_diameter_mm() && holes.least_diameter_mm() > holes.diameter_mm())
    return reader.error(path + ".drain_holes.least_diameter_mm",
                        fmt::format("is {:g}, above diameter_mm", holes.least_diameter_mm()));
  if (printer.has_printable_length())
    return check_curve(reader, path + ".printable_length", printer.printable_length());
  return absl::OkStatus();
}

}  // namespace

const std::string& ProfileFile::id() const {
  return std::visit([](const auto& known) -> const std::string& { return known.id(); }, profile);
}

absl::StatusOr<ProfileFile> parse_profile(std::string_view text, const std::string& file) {
  if (text.size() > kLargestProfileBytes)
    return absl::InvalidArgumentError(
        fmt::format("{}:1: {} bytes are too many for a profile; {} are the limit", file, text.size(),
                    kLargestProfileBytes));
  const auto document = parse_lined_json(text, file);
  if (!document.ok()) return document.status();
  const json& top = document->value;
  if (!top.is_object() || top.size() != 1 || !(top.contains("printer") || top.contains("material")))
    return absl::InvalidArgumentError(fmt::format(
        R"({}:1: a profile file is {{"printer": {{...}}}} or {{"material": {{...}}}}, one profile a file)",
        file));

  const ProfileReader reader(*document, file);
  ProfileFile out;
  out.file = file;
  if (top.contains("printer")) {
    v1::PrinterProfile printer;
    if (auto status = reader.read(top.at("printer"), "printer", printer); !status.ok()) return status;
    if (printer.build_direction() == v1::BUILD_DIRECTION_UNSPECIFIED)
      printer.set_build_direction(v1::BUILD_DIRECTION_UP);
    if (auto status = check_names(reader, "printer", printer); !status.ok()) return status;
    if (auto status = check_printer(reader, printer); !status.ok()) return status;
    if (auto status = check_sources(reader, "printer", printer); !status.ok()) return status;
    out.default_material_place = reader.place("printer.default_material_id");
    out.profile = std::move(printer);
    return out;
  }
  v1::MaterialProfile material;
  if (auto status = reader.read(top.at("material"), "material", material); !status.ok()) return status;
  if (auto status = check_names(reader, "material", material); !status.ok()) return status;
  if (auto status = check_sources(reader, "material", material); !status.ok()) return status;
  out.profile = std::move(material);
  return out;
}

}  // namespace skinframe::server
