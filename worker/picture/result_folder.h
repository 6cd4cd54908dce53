// SPDX-License-Identifier: GPL-3.0-or-later
// Which printers a result folder has pictures of, by its report.json and the files that are there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "worker/run/result.h"

namespace skinframe::picture {

struct Deformation {
  std::string load_case;
  std::filesystem::path path;
};

// What is there of one printer.
struct PrinterFiles {
  std::string name;   // the folder's; empty for a frame job, whose files lie in DIR itself
  std::string title;  // "fish.obj, sinterstation-hiq"
  std::optional<std::filesystem::path> frame, mesh;
  std::vector<Deformation> deformations;  // by name; the first kMostDeformations
  std::optional<std::filesystem::path> pinch;
};

inline constexpr std::size_t kMostDeformations = 64;

// `printer`: only that one; empty: all. At least one is returned, and each has at least one file.
// Errors: kIo where there is no such folder or report, kInvalidInput where it is none of ours or names no
// such printer.
Result<std::vector<PrinterFiles>> find_printers(const std::filesystem::path& directory,
                                                const std::string& printer);

}  // namespace skinframe::picture
