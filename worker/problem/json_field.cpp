// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/json_field.h"

#include <cmath>

namespace skinframe {

void refuse(const std::string& field, const std::string& what) {
  throw FieldError{invalid_input(fmt::format("{}: {}", field, what))};
}

Field Field::at(const char* key) const {
  if (!value_->is_object()) refuse(path_.empty() ? "problem" : path_, "must be an object");
  if (!value_->contains(key)) refuse(child(key), "is missing");
  return {(*value_)[key], child(key)};
}

std::size_t Field::size(std::size_t most) const {
  if (!value_->is_array()) refuse(path_, "must be a list");
  if (value_->size() > most)
    refuse(path_, fmt::format("{} entries, at most {} are taken", value_->size(), most));
  return value_->size();
}

double Field::number() const {
  if (!value_->is_number()) refuse(path_, "must be a number");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) refuse(path_, "must be finite");
  return number;
}

std::optional<double> Field::optional_number(const char* key) const {
  return has(key) ? std::optional(at(key).number()) : std::nullopt;
}

bool Field::boolean() const {
  if (!value_->is_boolean()) refuse(path_, "must be true or false");
  return value_->get<bool>();
}

std::string Field::text() const {
  if (!value_->is_string()) refuse(path_, "must be a string");
  return value_->get<std::string>();
}

int Field::node(std::size_t nodes) const {
  if (!value_->is_number_integer()) refuse(path_, "must be a whole number");
  const bool negative = !value_->is_number_unsigned() && value_->get<std::int64_t>() < 0;
  if (!negative && value_->get<std::uint64_t>() < nodes) return value_->get<int>();
  refuse(path_, fmt::format("{} is not a node (0..{})", value_->dump(), nodes - 1));
}

}  // namespace skinframe
