// SPDX-License-Identifier: Apache-2.0
// JSON into a message of a profile, field by field: unknown keys, wrong types and numbers out of the range
// that a worker takes are errors that name file, line and field.
#pragma once

#include <google/protobuf/message.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "server/lined_json/lined_json.h"

namespace skinframe::server {

class ProfileReader {
 public:
  // The document must outlive the reader.
  ProfileReader(const LinedJson& document, std::string file) : document_(document), file_(std::move(file)) {}

  // InvalidArgument, naming file, line and field.
  absl::Status error(const std::string& path, const std::string& what) const;
  // "FILE:LINE" of a field.
  std::string place(const std::string& path) const;

  // Every key is a field of the message; null leaves the field absent.
  absl::Status read(const nlohmann::json& object, const std::string& path,
                    google::protobuf::Message& message) const;

 private:
  using FieldDescriptor = google::protobuf::FieldDescriptor;
  static std::string fields_of(const google::protobuf::Message& message);

  // A number or flag that cannot be absent would else be 0 or false without anybody having said so.
  absl::Status check_given(const nlohmann::json& object, const std::string& path,
                           const google::protobuf::Message& message) const;
  absl::Status read_one(const nlohmann::json& value, const std::string& path, const FieldDescriptor& field,
                        google::protobuf::Message& message) const;
  absl::Status check_text(const nlohmann::json& value, const std::string& path) const;
  absl::Status read_word(const nlohmann::json& value, const std::string& path, const FieldDescriptor& field,
                         google::protobuf::Message& message) const;
  absl::Status read_list(const nlohmann::json& value, const std::string& path, const FieldDescriptor& field,
                         google::protobuf::Message& message) const;

  // "sources": texts by the name of a field beside it.
  absl::Status read_texts(const nlohmann::json& value, const std::string& path, const FieldDescriptor& field,
                          google::protobuf::Message& message) const;

  const LinedJson& document_;
  const std::string file_;
};

}  // namespace skinframe::server
