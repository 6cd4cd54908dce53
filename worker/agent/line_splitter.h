// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes of a pipe into lines, with a bound on what is kept: a child that never ends its line costs no memory.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace skinframe::agent {

class LineSplitter {
 public:
  using Handler = std::function<void(std::string_view line)>;

  // Lines longer than max_bytes are dropped as a whole when drop_long, else cut at max_bytes.
  LineSplitter(std::size_t max_bytes, bool drop_long, Handler handler)
      : max_bytes_(max_bytes), drop_long_(drop_long), handler_(std::move(handler)) {}

  void feed(std::string_view bytes);
  void finish();  // hands on a last line without line end
  std::size_t long_lines() const { return long_lines_; }

 private:
  void end_line();

  std::size_t max_bytes_;
  bool drop_long_;
  Handler handler_;
  std::string line_;
  bool too_long_ = false;
  std::size_t long_lines_ = 0;
};

}  // namespace skinframe::agent
