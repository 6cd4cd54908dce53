// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and words of a text mesh file, with the line number for messages. Lines end with \n, \r\n or \r.
// Views into the caller's bytes; nothing is copied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "worker/run/result.h"

namespace skinframe {

class LineScanner {
 public:
  explicit LineScanner(std::string_view text) : text_(text) {}

  // The next line without its end; empty optional after the last.
  std::optional<std::string_view> next();
  std::uint64_t line_number() const { return line_number_; }  // of the line given last, from 1
  std::size_t position() const { return position_; }          // of the first byte not yet given

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::uint64_t line_number_ = 0;
};

// Takes the first word off `rest` (blanks and tabs separate); empty when there is none.
std::string_view take_word(std::string_view& rest);

std::string_view trim(std::string_view text);
bool equal_ignoring_case(std::string_view a, std::string_view b);

// A finite number, in full: no trailing characters, a leading + allowed.
std::optional<double> parse_finite(std::string_view word);
std::optional<std::int64_t> parse_integer(std::string_view word);

// kInvalidInput: "line 17: MESSAGE". With quoted(), for words that come from a hostile file: cut to a
// length and without control characters.
Error line_error(std::uint64_t line, const std::string& message);
std::string quoted(std::string_view word);

}  // namespace skinframe
