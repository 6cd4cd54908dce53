// SPDX-License-Identifier: GPL-3.0-or-later
// A JSON value and where it stands in its document, so that whatever is wrong with it can be named:
// "struts[3].a: 44 is not a node (0..11)".
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "worker/run/result.h"

namespace skinframe {

// Thrown by a Field; whoever reads a document catches it and hands the error on.
struct FieldError {
  Error error;
};

[[noreturn]] void refuse(const std::string& field, const std::string& what);

class Field {
 public:
  Field(const nlohmann::json& value, std::string path) : value_(&value), path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  bool has(const char* key) const { return value_->contains(key) && !(*value_)[key].is_null(); }
  Field at(const char* key) const;
  Field at(std::size_t index) const { return {(*value_)[index], fmt::format("{}[{}]", path_, index)}; }
  std::size_t size(std::size_t most) const;  // of a list

  double number() const;  // finite
  std::optional<double> optional_number(const char* key) const;
  bool boolean() const;
  std::string text() const;
  int node(std::size_t nodes) const;  // an index below `nodes`
  template <int N>
  Eigen::Matrix<double, N, 1> vector() const {
    if (!value_->is_array() || value_->size() != N)
      refuse(path_, fmt::format("must be a list of {} numbers", N));
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) v[i] = at(static_cast<std::size_t>(i)).number();
    return v;
  }

 private:
  std::string child(const char* key) const { return path_.empty() ? key : path_ + "." + key; }
  const nlohmann::json* value_;
  std::string path_;
};

}  // namespace skinframe
