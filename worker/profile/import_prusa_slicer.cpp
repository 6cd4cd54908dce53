// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "worker/profile/import_profile.h"
#include "worker/profile/ini_presets.h"

namespace skinframe {
namespace {

constexpr double kLargestMm = 10'000;
constexpr std::size_t kMostNamesTold = 30;

Error wrong(const IniValue& value, const std::string& key, const std::string& what) {
  return invalid_input(fmt::format("{}:{}: {}: {}", value.file, value.line, key, what));
}

std::optional<double> number_at(const char*& at, const char* end) {
  double x = 0;
  const auto [stop, error] = std::from_chars(at, end, x);
  if (error != std::errc() || !std::isfinite(x)) return std::nullopt;
  at = stop;
  return x;
}

struct Bed {
  double x_mm, y_mm;
};

// "0x0,250x0,250x210,0x210": the box of the outline.
Result<Bed> read_bed(const IniValue& value) {
  const char* at = value.text.data();
  const char* const end = at + value.text.size();
  double low[2] = {kLargestMm, kLargestMm}, high[2] = {-kLargestMm, -kLargestMm};
  int corners = 0;
  while (at < end) {
    double corner[2];
    for (int k = 0; k < 2; ++k) {
      while (at < end && *at == ' ') ++at;
      const auto x = number_at(at, end);
      if (!x || std::abs(*x) > kLargestMm)
        return wrong(value, "bed_shape", "not a list of corners like 250x210");
      corner[k] = *x;
      const char separator = k == 0 ? 'x' : ',';
      while (at < end && *at == ' ') ++at;
      if (at < end && *at++ != separator)
        return wrong(value, "bed_shape", "not a list of corners like 250x210");
    }
    for (int k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], corner[k]);
      high[k] = std::max(high[k], corner[k]);
    }
    ++corners;
  }
  if (corners < 3 || !(high[0] - low[0] >= 1) || !(high[1] - low[1] >= 1))
    return wrong(value, "bed_shape", "fewer than three corners, or less than 1 mm across");
  return Bed{high[0] - low[0], high[1] - low[1]};
}

// The first of "0.4,0.4"; a list has one number an extruder.
Result<double> read_first(const IniValue& value, const std::string& key, double least, double most) {
  const char* at = value.text.data();
  const auto x = number_at(at, at + value.text.size());
  if (!x || !(*x >= least && *x <= most))
    return wrong(
        value, key,
        fmt::format("\"{}\" is no number within {:g} .. {:g}", value.text.substr(0, 40), least, most));
  return *x;
}

Result<std::string> choose(const IniPresets& presets, const std::string& wanted, const std::string& file) {
  const auto names = presets.names();
  if (!wanted.empty()) {
    if (presets.has(wanted)) return wanted;
  } else if (names.size() == 1) {
    return names.front();
  }
  std::string known;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNamesTold); ++i) known += "\n  " + names[i];
  if (names.size() > kMostNamesTold) known += fmt::format("\n  and {} more", names.size() - kMostNamesTold);
  return invalid_input(
      wanted.empty()
          ? fmt::format("{}: {} printers are in it; choose one with --preset:{}", file, names.size(), known)
          : fmt::format("{}: no printer \"{}\" is in it; there are:{}", file, wanted, known));
}

}  // namespace

Result<ProfileDraft> import_prusa_slicer(const std::filesystem::path& file, const std::string& preset) {
  const auto presets = IniPresets::read(file);
  if (!presets) return presets.error();
  const auto name = choose(*presets, preset, file.string());
  if (!name) return name.error();
  const auto missing = presets->missing_parents(*name);
  if (!missing) return missing.error();

  const auto technology = presets->find(*name, "printer_technology");
  ProfileDraft draft = ProfileDraft::printer(technology && technology->text == "SLA" ? "resin" : "extrusion");
  draft.name(*name);
  for (const std::string& parent : *missing)
    draft.note(fmt::format(
        "inherits from \"{}\", which is neither in the file nor beside it: what it says is left out",
        parent));
  const auto source = [&](const IniValue& value, const char* key) {
    return fmt::format("PrusaSlicer preset \"{}\": {}, {} line {}", *name, key, value.file, value.line);
  };
  if (const auto bed = presets->find(*name, "bed_shape")) {
    const auto size = read_bed(*bed);
    if (!size) return size.error();
    draft.set("tray_x_mm", size->x_mm, source(*bed, "bed_shape"));
    draft.set("tray_y_mm", size->y_mm, source(*bed, "bed_shape"));
  }
  if (const auto height = presets->find(*name, "max_print_height")) {
    const auto mm = read_first(*height, "max_print_height", 0, kLargestMm);
    if (!mm) return mm.error();
    if (*mm >= 1) draft.set("tray_z_mm", *mm, source(*height, "max_print_height"));  // 0: not set
  }
  if (const auto nozzle = presets->find(*name, "nozzle_diameter");
      nozzle && !(technology && technology->text == "SLA")) {
    const auto mm = read_first(*nozzle, "nozzle_diameter", 0.01, 100);
    if (!mm) return mm.error();
    draft.set("nozzle_mm", *mm, source(*nozzle, "nozzle_diameter"));
  }
  return draft;
}

}  // namespace skinframe
