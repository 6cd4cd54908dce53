// SPDX-License-Identifier: GPL-3.0-or-later
// One honest result, made once for all tests of the program, and copies of it in which a test tells a lie.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/worker/pipeline/small_job.h"

namespace skinframe::check {

using nlohmann::json;
namespace fs = std::filesystem;

inline constexpr const char* kPrinter = "sinterstation-hiq";

json read_json(const fs::path& path);
void write_json(const fs::path& path, const json& document);

class CheckTest : public testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  static fs::path honest() { return folder_->path() / "honest"; }

  // The names of the claims that do not hold, after `spoil` changed a copy.
  static std::vector<std::string> denied(const std::function<void(const fs::path&)>& spoil,
                                         const fs::path& from = honest());
  // The same; the lie is in the printer's part of report.json.
  static std::vector<std::string> denied_report(const std::function<void(json&)>& lie,
                                                const fs::path& from = honest());
  static std::vector<std::string> denied_frame(const std::function<void(json&)>& lie);

  static test::TemporaryFolder* folder_;
};

MATCHER_P(Names, name, "") { return std::find(arg.begin(), arg.end(), name) != arg.end(); }

}  // namespace skinframe::check
