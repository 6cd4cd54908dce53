// SPDX-License-Identifier: GPL-3.0-or-later
// Rows for people. README.md beside tells how to read them.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/optimise/row.h"

namespace skinframe::bench {

std::string table_head();
// `ipopt`: the row of Ipopt on the same frame and load, for the ratios; may be null.
std::string table_line(const Row& row, const Row* ipopt);

// Nodes, struts and volume of each stage of a whole loop.
std::string stage_lines(const Row& row);

// The paper's figures for its hanging ball.
std::string paper_lines();

}  // namespace skinframe::bench
