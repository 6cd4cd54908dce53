// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/app/profile_verbs.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "worker/profile/fit_printable_length.h"
#include "worker/profile/import_profile.h"

namespace skinframe {
namespace {

using Json = nlohmann::ordered_json;

// Exit codes of the command line (README of client/).
constexpr int kOk = 0, kUsage = 2, kBadInput = 3, kInternal = 5;

int fail(const Error& error) {
  std::cerr << "skinframe: " << error.message << '\n';
  return error.kind == ErrorKind::kInternal ? kInternal : kBadInput;
}

// Nanometres are no news to a printer.
double rounded(double mm) { return std::round(mm * 1e6) / 1e6; }

// {"printable_length": {...}}, to be pasted into a profile file.
Json fragment(const CalibrationFit& fit, std::size_t struts, const std::string& file) {
  Json points = Json::array();
  for (const PrintableLength::Point& point : fit.points)
    points.push_back({{"angle_deg", point.angle_deg}, {"length_mm", *point.length_mm}});
  return {
      {"printable_length",
       {{"points", std::move(points)},
        {"is_default", false},
        {"source", fmt::format("skinframe calibrate: {} printed test struts of {}, least squares that never "
                               "rise, residual rms {:.3f} mm, largest {:.3f} mm",
                               struts, file, fit.rms_mm, fit.largest_mm)}}}};
}

Json fit_json(const std::vector<CalibrationPoint>& points, const CalibrationFit& fit, const Json& made) {
  Json residuals = Json::array();
  for (std::size_t i = 0; i < points.size(); ++i)
    residuals.push_back({{"line", points[i].line},
                         {"angle_deg", points[i].angle_deg},
                         {"length_mm", points[i].length_mm},
                         {"fitted_mm", rounded(fit.fitted_mm[i])},
                         {"residual_mm", rounded(points[i].length_mm - fit.fitted_mm[i])}});
  Json out = made;
  out["residuals"] = std::move(residuals);
  out["rms_mm"] = rounded(fit.rms_mm);
  out["largest_mm"] = rounded(fit.largest_mm);
  out["steepest_deg"] = fit.steepest_deg();
  out["flattest_deg"] = fit.flattest_deg();
  out["usable_in_a_profile"] = fit.reaches_flat();
  return out;
}

void print_fit(const std::vector<CalibrationPoint>& points, const CalibrationFit& fit) {
  fmt::print("angle deg  printed mm  curve mm  printed - curve mm\n");
  for (std::size_t i = 0; i < points.size(); ++i)
    fmt::print("{:>9g}  {:>10g}  {:>8.3f}  {:>18.3f}\n", points[i].angle_deg, points[i].length_mm,
               fit.fitted_mm[i], points[i].length_mm - fit.fitted_mm[i]);
  fmt::print("residual: rms {:.3f} mm, largest {:.3f} mm\n", fit.rms_mm, fit.largest_mm);
  fmt::print("holds from {:g} to {:g} degrees from the vertical; steeper struts count as the steepest one\n",
             fit.steepest_deg(), fit.flattest_deg());
  if (!fit.reaches_flat())
    fmt::print(
        "nothing is known of struts flatter than {:g} degrees: a profile needs some that lie flat, at 90\n",
        fit.flattest_deg());
}

}  // namespace

ProfileVerbs::ProfileVerbs(CLI::App& app) {
  calibrate_ = app.add_subcommand("calibrate", "Longest printable strut by angle, from printed test struts");
  calibrate_->add_option("POINTS", file_, "CSV: angle_deg,length_mm; a line a test strut")->required();
  calibrate_->add_option("--out", out_, "File for \"printable_length\" of a profile (JSON)");
  calibrate_->add_flag("--json", json_, "Curve and residuals as JSON");
  const auto add_import = [&](const char* name, const char* from, const char* what) {
    CLI::App* parent = app.add_subcommand(name, "Import from another program's file");
    parent->require_subcommand(1);
    CLI::App* import = parent->add_subcommand("import", from);
    import->add_option("FILE", file_, what)->required();
    import->add_option("--preset", preset_, "Which one, where the file has several");
    import->add_option("--id", id_, "Id of the profile (default: made of the name)");
    import->add_option("--out", out_, "File to write (default: stdout)");
    import->add_flag("--json", json_, "The profile is JSON in any case");
    return import;
  };
  import_printer_ = add_import("printers", "A printer's bed, height and nozzle as a profile file",
                               "PrusaSlicer .ini (bundle or preset) or Cura .def.json");
  import_material_ = add_import("materials", "A material's name, density and price as a profile file",
                                "Spoolman filament, or a list of them (JSON)");
}

std::optional<int> ProfileVerbs::run() {
  if (calibrate_->parsed()) return run_calibrate();
  if (import_printer_->parsed()) return run_import(true);
  if (import_material_->parsed()) return run_import(false);
  return std::nullopt;
}

int ProfileVerbs::run_calibrate() const {
  const auto points = read_calibration(file_);
  if (!points) return fail(points.error());
  const auto fit = fit_printable_length(*points);
  if (!fit) return fail(fit.error());
  if (!out_.empty() && !fit->reaches_flat())
    return fail(invalid_input(
        fmt::format("{}: the flattest strut stands at {:g} degrees; a profile's curve ends with one "
                    "that lies flat: print bridges and add their length at 90",
                    file_, fit->flattest_deg())));
  const Json made = fragment(*fit, points->size(), std::filesystem::path(file_).filename().string());
  if (json_)
    std::cout << fit_json(*points, *fit, made).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  else
    print_fit(*points, *fit);
  if (out_.empty()) return kOk;
  std::ofstream out(out_, std::ios::binary);
  out << made.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  if (!out.flush()) return fail(internal_error(fmt::format("{}: cannot be written", out_)));
  return kOk;
}

int ProfileVerbs::run_import(bool is_printer) const {
  auto draft = is_printer ? import_printer(file_, preset_) : import_spoolman(file_, preset_);
  if (!draft) return fail(draft.error());
  if (!id_.empty()) {
    if (id_ != id_from_name(id_)) {
      std::cerr << "skinframe: --id: \"" << id_ << "\" is not 1 .. 64 of a-z, 0-9 and single -\n";
      return kUsage;
    }
    draft.value().set_id(id_);
  }
  if (out_.empty()) {
    std::cout << draft->text();
  } else {
    std::ofstream out(out_, std::ios::binary);
    out << draft->text();
    if (!out.flush()) return fail(internal_error(fmt::format("{}: cannot be written", out_)));
  }
  for (const std::string& note : draft->notes()) std::cerr << "note: " << note << '\n';
  std::cerr << fmt::format("not known (null): {}\n", fmt::join(draft->unknown(), ", "));
  return kOk;
}

}  // namespace skinframe
