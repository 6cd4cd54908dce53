// SPDX-License-Identifier: Apache-2.0
// Rows of words as aligned columns.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace skinframe::client {

using Row = std::vector<std::string>;

// Columns as wide as their widest cell; the first ones to the left, figures to the right. A line a row.
std::string table(const std::vector<Row>& rows, std::size_t left_columns);

// The value by the fmt format, or "-" for one that is not there.
std::string or_dash(bool present, double value, const char* format);

}  // namespace skinframe::client
