// SPDX-License-Identifier: Apache-2.0
#include "server/catalog/profile_file.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "server/lined_json/lined_json.h"

namespace skinframe::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using nlohmann::json;

constexpr std::size_t kLongestText = 2000;
constexpr std::size_t kLongestId = 64;
constexpr int kMostPoints = 64;

struct Range {
  double least, most;
};
// What a worker takes, by the field's name.
const std::map<std::string, Range>& ranges() {
  static const std::map<std::string, Range> all = {
      {"min_radius_mm", {0.01, 50}},
      {"max_internal_radius_mm", {0.01, 500}},
      {"tray_x_mm", {1, 10'000}},
      {"tray_y_mm", {1, 10'000}},
      {"tray_z_mm", {1, 10'000}},
      {"neck_diameter_mm", {0.01, 100}},
      {"nozzle_mm", {0.01, 100}},
      {"diameter_mm", {0.1, 1000}},
      {"least_count", {1, 64}},
      {"least_diameter_mm", {0.1, 1000}},
      {"angle_deg", {0, 90}},
      {"length_mm", {1e-3, 1e6}},
      {"tensile_modulus_mpa", {1e-3, 1e7}},
      {"shear_modulus_mpa", {1e-3, 1e7}},
      {"tensile_strength_mpa", {1e-3, 1e6}},
      {"shear_strength_mpa", {1e-3, 1e6}},
      {"slenderness", {1, 1e6}},
      {"density_g_cm3", {1e-3, 100}},
      {"price_per_kg", {0, 1e9}},
  };
  return all;
}

// "extrusion" of PRINT_PROCESS_EXTRUSION; its value 0 is no word of the format.
std::string word_of(const google::protobuf::EnumDescriptor& type, const std::string& name) {
  std::string word = name.substr(type.value(0)->name().size() - std::string_view("UNSPECIFIED").size());
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  return word;
}

class Reader {
 public:
  Reader(const LinedJson& document, std::string file) : document_(document), file_(std::move(file)) {}

  absl::Status error(const std::string& path, const std::string& what) const {
    return absl::InvalidArgumentError(fmt::format("{}: {}: {}", place(path), path, what));
  }
  std::string place(const std::string& path) const {
    return fmt::format("{}:{}", file_, document_.line(path));
  }

  // Every key is a field of the message; null leaves the field absent.
  absl::Status read(const json& object, const std::string& path, Message& message) const {
    if (!object.is_object()) return error(path, "is not an object");
    for (const auto& [key, value] : object.items()) {
      const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(key);
      const std::string here = path + "." + key;
      if (field == nullptr) return error(here, fmt::format("unknown field; known: {}", fields_of(message)));
      if (value.is_null()) continue;
      if (auto status = field->is_map()        ? read_texts(value, here, *field, message)
                        : field->is_repeated() ? read_list(value, here, *field, message)
                                               : read_one(value, here, *field, message);
          !status.ok())
        return status;
    }
    return check_given(object, path, message);
  }

 private:
  static std::string fields_of(const Message& message) {
    std::string names;
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i)
      names += (i > 0 ? ", " : "") + message.GetDescriptor()->field(i)->name();
    return names;
  }

  // A number or flag that cannot be absent would else be 0 or false without anybody having said so.
  absl::Status check_given(const json& object, const std::string& path, const Message& message) const {
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
      const FieldDescriptor& field = *message.GetDescriptor()->field(i);
      const auto type = field.cpp_type();
      const bool counts = type == FieldDescriptor::CPPTYPE_DOUBLE || type == FieldDescriptor::CPPTYPE_INT32 ||
                          type == FieldDescriptor::CPPTYPE_BOOL;
      if (!counts || field.has_presence()) continue;
      if (const auto at = object.find(field.name()); at == object.end() || at->is_null())
        return error(path + "." + field.name(), "is missing");
    }
    return absl::OkStatus();
  }

  absl::Status read_one(const json& value, const std::string& path, const FieldDescriptor& field,
                        Message& message) const {
    const auto& reflection = *message.GetReflection();
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
      case FieldDescriptor::CPPTYPE_INT32: {
        const bool whole = field.cpp_type() == FieldDescriptor::CPPTYPE_INT32;
        if (whole ? !value.is_number_integer() : !value.is_number())
          return error(path, whole ? "is not a whole number" : "is not a number; null where it is not known");
        const auto range = ranges().at(field.name());
        const double number = value.get<double>();
        if (!(number >= range.least && number <= range.most))
          return error(path,
                       fmt::format("is {:g}, must be within {:g} .. {:g}", number, range.least, range.most));
        if (whole)
          reflection.SetInt32(&message, &field, static_cast<int>(number));
        else
          reflection.SetDouble(&message, &field, number);
        return absl::OkStatus();
      }
      case FieldDescriptor::CPPTYPE_BOOL:
        if (!value.is_boolean()) return error(path, "is neither true nor false");
        reflection.SetBool(&message, &field, value.get<bool>());
        return absl::OkStatus();
      case FieldDescriptor::CPPTYPE_ENUM:
        return read_word(value, path, field, message);
      case FieldDescriptor::CPPTYPE_MESSAGE:
        return read(value, path, *reflection.MutableMessage(&message, &field));
      default:
        break;
    }
    if (auto status = check_text(value, path); !status.ok()) return status;
    reflection.SetString(&message, &field, value.get<std::string>());
    return absl::OkStatus();
  }

  absl::Status check_text(const json& value, const std::string& path) const {
    if (!value.is_string()) return error(path, "is not a text");
    if (value.get_ref<const std::string&>().size() > kLongestText)
      return error(path, fmt::format("is longer than {} bytes", kLongestText));
    return absl::OkStatus();
  }

  absl::Status read_word(const json& value, const std::string& path, const FieldDescriptor& field,
                         Message& message) const {
    const auto& type = *field.enum_type();
    std::string known;
    for (int i = 1; i < type.value_count(); ++i) {
      const std::string word = word_of(type, type.value(i)->name());
      if (value.is_string()) {
        const auto& given = value.get_ref<const std::string&>();
        if (std::equal(given.begin(), given.end(), word.begin(), word.end(),
                       [](unsigned char a, unsigned char b) { return std::tolower(a) == b; })) {
          message.GetReflection()->SetEnumValue(&message, &field, type.value(i)->number());
          return absl::OkStatus();
        }
      }
      known += (i > 1 ? ", " : "") + word;
    }
    return error(path, fmt::format("is none of: {}", known));
  }

  absl::Status read_list(const json& value, const std::string& path, const FieldDescriptor& field,
                         Message& message) const {
    if (!value.is_array()) return error(path, "is not a list");
    for (std::size_t i = 0; i < value.size(); ++i) {
      auto& element = *message.GetReflection()->AddMessage(&message, &field);
      if (auto status = read(value[i], fmt::format("{}[{}]", path, i), element); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  // "sources": texts by the name of a field beside it.
  absl::Status read_texts(const json& value, const std::string& path, const FieldDescriptor& field,
                          Message& message) const {
    if (!value.is_object()) return error(path, "is not an object");
    for (const auto& [key, text] : value.items()) {
      const std::string here = path + "." + key;
      if (auto status = check_text(text, here); !status.ok()) return status;
      if (message.GetDescriptor()->FindFieldByName(key) == nullptr)
        return error(here, fmt::format("is no field; known: {}", fields_of(message)));
      auto& entry = *message.GetReflection()->AddMessage(&message, &field);
      entry.GetReflection()->SetString(&entry, field.message_type()->map_key(), key);
      entry.GetReflection()->SetString(&entry, field.message_type()->map_value(), text.get<std::string>());
    }
    return absl::OkStatus();
  }

  const LinedJson& document_;
  const std::string file_;
};

bool is_id(const std::string& id) {
  return !id.empty() && id.size() <= kLongestId && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

template <class Profile>
absl::Status check_names(const Reader& reader, const std::string& path, const Profile& profile) {
  if (!is_id(profile.id()))
    return reader.error(path + ".id",
                        fmt::format("\"{}\" is not 1 .. {} of a-z, 0-9 and -", profile.id(), kLongestId));
  if (profile.display_name().empty()) return reader.error(path + ".display_name", "is missing");
  return absl::OkStatus();
}

// A number that nobody can trace is worth no more than a guess.
template <class Profile>
absl::Status check_sources(const Reader& reader, const std::string& path, const Profile& profile) {
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
absl::Status check_curve(const Reader& reader, const std::string& path, const v1::PrintableLength& curve) {
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

absl::Status check_printer(const Reader& reader, const v1::PrinterProfile& printer) {
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

  const Reader reader(*document, file);
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
