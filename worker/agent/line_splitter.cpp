// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/line_splitter.h"

namespace skinframe::agent {

void LineSplitter::feed(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::string_view part = bytes.substr(0, end);
    const std::size_t room = max_bytes_ - line_.size();
    line_.append(part.substr(0, room));
    if (part.size() > room) too_long_ = true;
    if (end == std::string_view::npos) return;
    end_line();
    bytes.remove_prefix(end + 1);
  }
}

void LineSplitter::finish() {
  if (!line_.empty() || too_long_) end_line();
}

void LineSplitter::end_line() {
  if (too_long_) ++long_lines_;
  if (!too_long_ || !drop_long_) handler_(line_);
  line_.clear();
  too_long_ = false;
}

}  // namespace skinframe::agent
