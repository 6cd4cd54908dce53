// SPDX-License-Identifier: GPL-3.0-or-later
// What report.json says in figures of one printer's result, or of the solution of a frame problem.
//
// Throw nlohmann's exceptions where the report is not what it has to be.
#pragma once

#include <nlohmann/json.hpp>

#include "worker/check/exported.h"

namespace skinframe::check {

// An entry of "printers"; files, supports and drain holes are read by others.
ExportedPrinter parse_printer(const nlohmann::json& item);

// "frame" of a solution's report.
ExportedPrinter parse_solution(const nlohmann::json& item);

}  // namespace skinframe::check
