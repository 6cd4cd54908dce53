// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "worker/profile/fit_printable_length.h"
#include "worker/profile/import_profile.h"

namespace skinframe {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr std::size_t kMostStruts = 10'000;
constexpr double kLongestMm = 10'000;
constexpr std::string_view kHeader = "angle_deg,length_mm";

std::string_view trimmed(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

// The whole text as one number, or nothing.
std::optional<double> number(std::string_view text) {
  text = trimmed(text);
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(x)) return std::nullopt;
  return x;
}

}  // namespace

Result<std::vector<CalibrationPoint>> read_calibration(const std::filesystem::path& file) {
  const auto content = read_text_file(file, kMostBytes);
  if (!content) return content.error();
  std::string_view text = *content;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // what spreadsheets put before UTF-8
  std::vector<CalibrationPoint> points;
  std::set<double> angles;
  bool header = false;
  int line_number = 0;
  const auto wrong = [&](const std::string& what) {
    return invalid_input(fmt::format("{}:{}: {}", file.string(), std::max(1, line_number), what));
  };
  for (std::size_t from = 0; from < text.size();) {
    const auto to = std::min(text.find('\n', from), text.size());
    const std::string_view line = trimmed(text.substr(from, to - from));
    from = to + 1;
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    if (!header) {
      if (line != kHeader) return wrong(fmt::format("the first line must be `{}`", kHeader));
      header = true;
      continue;
    }
    const auto comma = line.find(',');
    if (comma == std::string_view::npos || line.find(',', comma + 1) != std::string_view::npos)
      return wrong(fmt::format("not two columns: {}", kHeader));
    const auto angle = number(line.substr(0, comma)), length = number(line.substr(comma + 1));
    if (!angle || *angle < 0 || *angle > 90)
      return wrong("angle_deg: not a number within 0 .. 90 (from the vertical: 90 lies flat)");
    if (!length || !(*length > 0) || *length > kLongestMm)
      return wrong(fmt::format("length_mm: not a number above 0 and up to {:g}", kLongestMm));
    if (points.size() == kMostStruts) return wrong(fmt::format("more than {} struts", kMostStruts));
    points.push_back({*angle, *length, line_number});
    angles.insert(*angle);
  }
  if (!header) return wrong(fmt::format("nothing is in it; the first line must be `{}`", kHeader));
  if (angles.size() < 2)
    return wrong(fmt::format("struts of {} angle; a curve needs two angles at least", angles.size()));
  return points;
}

}  // namespace skinframe
