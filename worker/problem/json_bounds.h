// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds on a JSON text before a tree is made of it: a file of few bytes can ask for a deep tree, one of many
// for more memory than the machine has.
#pragma once

#include <cstddef>
#include <istream>

#include "worker/run/result.h"

namespace skinframe {

struct JsonLimits {
  std::size_t values = 0;
  int depth = 0;
};

// Reads the text through without keeping any of it. kInvalidInput: not JSON, or beyond the limits.
Status check_json_bounds(std::istream& text, const JsonLimits& limits);

}  // namespace skinframe
