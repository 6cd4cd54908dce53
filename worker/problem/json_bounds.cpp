// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/json_bounds.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace skinframe {
namespace {

using nlohmann::json;

class Counter : public nlohmann::json_sax<json> {
 public:
  explicit Counter(const JsonLimits& limits) : limits_(limits) {}
  const std::string& refusal() const { return refusal_; }

  bool null() override { return one(); }
  bool boolean(bool) override { return one(); }
  bool number_integer(number_integer_t) override { return one(); }
  bool number_unsigned(number_unsigned_t) override { return one(); }
  bool number_float(number_float_t, const string_t&) override { return one(); }
  bool string(string_t&) override { return one(); }
  bool binary(binary_t&) override { return one(); }
  bool key(string_t&) override { return one(); }
  bool start_object(std::size_t) override { return open(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& e) override {
    refusal_ = fmt::format("not valid JSON ({})", e.what());
    return false;
  }

 private:
  bool one() {
    if (++values_ <= limits_.values) return true;
    refusal_ = fmt::format("more than {} values", limits_.values);
    return false;
  }
  bool open() {
    if (++depth_ > limits_.depth) {
      refusal_ = fmt::format("nested more than {} deep", limits_.depth);
      return false;
    }
    return one();
  }
  bool close() {
    --depth_;
    return true;
  }

  const JsonLimits& limits_;
  std::size_t values_ = 0;
  int depth_ = 0;
  std::string refusal_;
};

}  // namespace

Status check_json_bounds(std::istream& text, const JsonLimits& limits) {
  Counter counter(limits);
  if (!json::sax_parse(text, &counter)) return invalid_input(counter.refusal());
  return ok_status();
}

}  // namespace skinframe
