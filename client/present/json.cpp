// SPDX-License-Identifier: Apache-2.0
#include "client/present/json.h"

#include <fmt/core.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/duration.pb.h>
#include <google/protobuf/timestamp.pb.h>

#include "client/present/words.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
using Json = nlohmann::ordered_json;

// JOB_STATE_RUNNING of enum JobState is "RUNNING": the prefix is that of the value 0, X_UNSPECIFIED.
Json enum_word(const google::protobuf::EnumDescriptor& type, int number) {
  if (&type == v1::Reason_descriptor()) return reason_word(static_cast<v1::Reason>(number));
  const auto* value = type.FindValueByNumber(number);
  if (value == nullptr) return number;
  constexpr std::string_view kZero = "UNSPECIFIED";
  const std::size_t prefix = type.value(0)->name().size() - kZero.size();
  return value->name().substr(prefix);
}

Json submessage(const Message& message) {
  if (const auto* time = dynamic_cast<const google::protobuf::Timestamp*>(&message)) return time_text(*time);
  if (const auto* span = dynamic_cast<const google::protobuf::Duration*>(&message)) {
    return static_cast<double>(span->seconds()) + 1e-9 * span->nanos();
  }
  return to_json(message);
}

Json single(const Message& m, const Reflection& r, const FieldDescriptor& f) {
  switch (f.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return r.GetInt32(m, &f);
    case FieldDescriptor::CPPTYPE_INT64:
      return r.GetInt64(m, &f);
    case FieldDescriptor::CPPTYPE_UINT32:
      return r.GetUInt32(m, &f);
    case FieldDescriptor::CPPTYPE_UINT64:
      return r.GetUInt64(m, &f);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return r.GetDouble(m, &f);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return r.GetFloat(m, &f);
    case FieldDescriptor::CPPTYPE_BOOL:
      return r.GetBool(m, &f);
    case FieldDescriptor::CPPTYPE_ENUM:
      return enum_word(*f.enum_type(), r.GetEnumValue(m, &f));
    case FieldDescriptor::CPPTYPE_STRING:
      return r.GetString(m, &f);
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return submessage(r.GetMessage(m, &f));
  }
  return nullptr;
}

Json element(const Message& m, const Reflection& r, const FieldDescriptor& f, int i) {
  switch (f.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return r.GetRepeatedInt32(m, &f, i);
    case FieldDescriptor::CPPTYPE_INT64:
      return r.GetRepeatedInt64(m, &f, i);
    case FieldDescriptor::CPPTYPE_UINT32:
      return r.GetRepeatedUInt32(m, &f, i);
    case FieldDescriptor::CPPTYPE_UINT64:
      return r.GetRepeatedUInt64(m, &f, i);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return r.GetRepeatedDouble(m, &f, i);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return r.GetRepeatedFloat(m, &f, i);
    case FieldDescriptor::CPPTYPE_BOOL:
      return r.GetRepeatedBool(m, &f, i);
    case FieldDescriptor::CPPTYPE_ENUM:
      return enum_word(*f.enum_type(), r.GetRepeatedEnumValue(m, &f, i));
    case FieldDescriptor::CPPTYPE_STRING:
      return r.GetRepeatedString(m, &f, i);
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return submessage(r.GetRepeatedMessage(m, &f, i));
  }
  return nullptr;
}

// Map fields of the API are string to string.
Json string_map(const Message& m, const Reflection& r, const FieldDescriptor& f) {
  std::map<std::string, std::string> sorted;
  for (int i = 0; i < r.FieldSize(m, &f); ++i) {
    const Message& entry = r.GetRepeatedMessage(m, &f, i);
    const Reflection& er = *entry.GetReflection();
    sorted[er.GetString(entry, f.message_type()->map_key())] =
        er.GetString(entry, f.message_type()->map_value());
  }
  Json out = Json::object();
  for (const auto& [key, value] : sorted) out[key] = value;
  return out;
}

}  // namespace

Json to_json(const Message& message) {
  const Reflection& reflection = *message.GetReflection();
  Json out = Json::object();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    if (field.is_map()) {
      out[field.name()] = string_map(message, reflection, field);
    } else if (field.is_repeated()) {
      Json list = Json::array();
      for (int k = 0; k < reflection.FieldSize(message, &field); ++k) {
        list.push_back(element(message, reflection, field, k));
      }
      out[field.name()] = std::move(list);
    } else if (!field.has_presence() || reflection.HasField(message, &field)) {
      out[field.name()] = single(message, reflection, field);
    }
  }
  return out;
}

std::string to_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void print_json(const Json& json) { fmt::print("{}\n", to_text(json)); }

}  // namespace skinframe::client
