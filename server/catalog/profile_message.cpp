// SPDX-License-Identifier: Apache-2.0
#include "server/catalog/profile_message.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cctype>
#include <map>

namespace skinframe::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using nlohmann::json;

constexpr std::size_t kLongestText = 2000;

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

}  // namespace

absl::Status ProfileReader::error(const std::string& path, const std::string& what) const {
  return absl::InvalidArgumentError(fmt::format("{}: {}: {}", place(path), path, what));
}

std::string ProfileReader::place(const std::string& path) const {
  return fmt::format("{}:{}", file_, document_.line(path));
}

absl::Status ProfileReader::read(const json& object, const std::string& path, Message& message) const {
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

std::string ProfileReader::fields_of(const Message& message) {
  std::string names;
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i)
    names += (i > 0 ? ", " : "") + message.GetDescriptor()->field(i)->name();
  return names;
}

// A number or flag that cannot be absent would else be 0 or false without anybody having said so.
absl::Status ProfileReader::check_given(const json& object, const std::string& path,
                                        const Message& message) const {
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

absl::Status ProfileReader::read_one(const json& value, const std::string& path, const FieldDescriptor& field,
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

absl::Status ProfileReader::check_text(const json& value, const std::string& path) const {
  if (!value.is_string()) return error(path, "is not a text");
  if (value.get_ref<const std::string&>().size() > kLongestText)
    return error(path, fmt::format("is longer than {} bytes", kLongestText));
  return absl::OkStatus();
}

absl::Status ProfileReader::read_word(const json& value, const std::string& path,
                                      const FieldDescriptor& field, Message& message) const {
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

absl::Status ProfileReader::read_list(const json& value, const std::string& path,
                                      const FieldDescriptor& field, Message& message) const {
  if (!value.is_array()) return error(path, "is not a list");
  for (std::size_t i = 0; i < value.size(); ++i) {
    auto& element = *message.GetReflection()->AddMessage(&message, &field);
    if (auto status = read(value[i], fmt::format("{}[{}]", path, i), element); !status.ok()) return status;
  }
  return absl::OkStatus();
}

// "sources": texts by the name of a field beside it.
absl::Status ProfileReader::read_texts(const json& value, const std::string& path,
                                       const FieldDescriptor& field, Message& message) const {
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

}  // namespace skinframe::server
