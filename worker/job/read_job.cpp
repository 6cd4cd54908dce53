// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/read_job.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>

namespace skinframe {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kMaxJobFileBytes = 16 << 20;

// Thrown inside this file only; parse_job turns it into an Error.
struct Refusal {
  Error error;
};
[[noreturn]] void refuse(const std::string& message) { throw Refusal{invalid_input("job.json: " + message)}; }

double number(const json& object, const char* key, double least, double most) {
  const json& value = object.at(key);
  if (!value.is_number()) refuse(fmt::format("{} is not a number", key));
  const double x = value.get<double>();
  if (!(std::isfinite(x) && x >= least && x <= most))
    refuse(fmt::format("{} is {:g}, outside {:g} .. {:g}", key, x, least, most));
  return x;
}

bool is_given(const json& object, const char* key) {
  return object.contains(key) && !object.at(key).is_null();
}

std::optional<double> optional_number(const json& object, const char* key, double least, double most) {
  if (!is_given(object, key)) return std::nullopt;
  return number(object, key, least, most);
}

std::optional<int> optional_count(const json& object, const char* key, int least, int most) {
  if (!is_given(object, key)) return std::nullopt;
  if (!object.at(key).is_number_integer()) refuse(fmt::format("{} is not a whole number", key));
  return static_cast<int>(number(object, key, least, most));
}

Eigen::Vector3d vector3(const json& value, const std::string& place) {
  if (!value.is_array() || value.size() != 3) refuse(place + " is not [x, y, z]");
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) {
    if (!value[i].is_number() || !std::isfinite(value[i].get<double>()))
      refuse(place + " holds something that is not a number");
    v[i] = value[i].get<double>();
  }
  return v;
}

template <class Enum>
Enum choice(const json& object, const char* key, const std::map<std::string, Enum>& known) {
  const auto text = object.at(key).get<std::string>();
  const auto it = known.find(text);
  if (it == known.end()) refuse(fmt::format("{} \"{}\" is not known", key, text));
  return it->second;
}

PrintableLength parse_printable_length(const json& item) {
  std::vector<PrintableLength::Point> points;
  for (const json& point : item.at("points"))
    points.push_back({number(point, "angle_deg", 0, 90), optional_number(point, "length_mm", 1e-3, 1e6)});
  auto curve = PrintableLength::make(std::move(points), item.at("is_default").get<bool>(),
                                     item.at("source").get<std::string>());
  if (!curve) refuse("printable_length: " + curve.error().message);
  return std::move(curve).value();
}

PrinterRequest parse_printer(const json& item) {
  PrinterRequest request;
  const json& printer = item.at("printer");
  request.printer.id = printer.at("id").get<std::string>();
  request.printer.process = choice<PrintProcess>(printer, "process",
                                                 {{"powder", PrintProcess::kPowder},
                                                  {"extrusion", PrintProcess::kExtrusion},
                                                  {"resin", PrintProcess::kResin}});
  request.printer.min_radius_mm = number(printer, "min_radius_mm", 0.01, 50);
  request.printer.tray_mm = vector3(printer.at("tray_mm"), "tray_mm");
  request.printer.max_internal_radius_mm =
      number(printer, "max_internal_radius_mm", request.printer.min_radius_mm, 500);
  if (is_given(printer, "printable_length"))
    request.printer.printable_length = parse_printable_length(printer.at("printable_length"));
  if (is_given(printer, "drain_holes")) {
    const json& rule = printer.at("drain_holes");
    const double diameter_mm = number(rule, "diameter_mm", 0.1, 1000);
    request.printer.drain_holes =
        DrainHoleRule{diameter_mm, optional_count(rule, "least_count", 1, 64).value_or(1),
                      optional_number(rule, "least_diameter_mm", 0.1, diameter_mm).value_or(diameter_mm)};
  }
  if (is_given(printer, "build_direction"))
    request.printer.build_direction = choice<BuildDirection>(
        printer, "build_direction", {{"up", BuildDirection::kUp}, {"hanging", BuildDirection::kHanging}});
  request.printer.neck_diameter_mm = optional_number(printer, "neck_diameter_mm", 0.01, 100);
  const json& material = item.at("material");
  request.material.id = material.at("id").get<std::string>();
  request.material.tensile_modulus_mpa = number(material, "tensile_modulus_mpa", 1e-3, 1e7);
  request.material.shear_modulus_mpa = number(material, "shear_modulus_mpa", 1e-3, 1e7);
  request.material.tensile_strength_mpa = optional_number(material, "tensile_strength_mpa", 1e-3, 1e6);
  request.material.shear_strength_mpa = optional_number(material, "shear_strength_mpa", 1e-3, 1e6);
  request.material.slenderness = optional_number(material, "slenderness", 1, 1e6);
  request.material.density_g_cm3 = number(material, "density_g_cm3", 1e-3, 100);
  request.price_per_kg = optional_number(material, "price_per_kg", 0, 1e9);
  // The id names a folder of the result.
  for (const std::string& id : {request.printer.id, request.material.id})
    if (id.empty() || id.size() > 64 ||
        id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos)
      refuse(fmt::format("id \"{}\" is not of [a-z0-9-]", id));
  return request;
}

Load parse_load(const json& item) {
  Load load;
  load.name = item.at("name").get<std::string>();
  if (is_given(item, "place"))
    load.where = choice<Place>(item, "place",
                               {{"top", Place::kTop},
                                {"bottom", Place::kBottom},
                                {"left", Place::kLeft},
                                {"right", Place::kRight},
                                {"front", Place::kFront},
                                {"back", Place::kBack}});
  else
    load.where = vector3(item.at("point_mm"), "point_mm");
  load.force_n = vector3(item.at("force_n"), "force_n");
  if (is_given(item, "radius_mm")) load.radius_mm = number(item, "radius_mm", 0.01, 1000);
  return load;
}

JobOptions parse_options(const json& item) {
  JobOptions options;
  options.up = choice<Up>(item, "up", {{"x", Up::kX}, {"y", Up::kY}, {"z", Up::kZ}});
  options.balance = choice<BalanceMode>(
      item, "balance",
      {{"auto", BalanceMode::kAuto}, {"require", BalanceMode::kRequire}, {"off", BalanceMode::kOff}});
  options.size_mm = optional_number(item, "size_mm", 1, 2000);
  options.skin_nodes = optional_count(item, "skin_nodes", 12, 20000);
  options.internal_nodes = optional_count(item, "internal_nodes", 0, 20000);
  options.voxel_mm = optional_number(item, "voxel_mm", 0.02, 5);
  options.no_optimize = item.at("no_optimize").get<bool>();
  options.verify = item.at("verify").get<bool>();
  options.order =
      choice<StageOrder>(item, "order", {{"tight", StageOrder::kTight}, {"paper", StageOrder::kPaper}});
  options.displacement_limit_mm = number(item, "displacement_limit_mm", 1e-3, 100);
  options.seed = item.at("seed").get<std::uint64_t>();
  options.smooth =
      choice<Smooth>(item, "smooth", {{"auto", Smooth::kAuto}, {"on", Smooth::kOn}, {"off", Smooth::kOff}});
  options.orient = choice<Orient>(item, "orient", {{"keep", Orient::kKeep}, {"best", Orient::kBest}});
  return options;
}

EarlierJob parse_warm_start(const json& item) {
  EarlierJob warm_start;
  warm_start.job_id = item.at("job_id").get<std::string>();
  for (const auto& [printer, path] : item.at("files").items())
    warm_start.files.emplace(printer, path.get<std::string>());
  return warm_start;
}

}  // namespace

Result<JobFile> parse_job(const json& document) {
  try {
    JobFile file;
    JobRequest& request = file.request;
    request.job_id = document.at("job_id").get<std::string>();
    request.mesh_name = document.at("mesh_name").get<std::string>();
    file.threads = static_cast<int>(number(document, "threads", 1, 256));
    if (is_given(document, "frame_problem_path")) {
      file.frame_problem = document.at("frame_problem_path").get<std::string>();
      return file;
    }
    request.mesh_path = document.at("mesh_path").get<std::string>();
    for (const json& item : document.at("printers")) request.printers.push_back(parse_printer(item));
    if (request.printers.empty()) refuse("printers is empty");
    for (const json& item : document.at("loads")) request.loads.push_back(parse_load(item));
    request.options = parse_options(document.at("options"));
    if (is_given(document, "warm_start")) request.warm_start = parse_warm_start(document.at("warm_start"));
    return file;
  } catch (const Refusal& refusal) {
    return refusal.error;
  } catch (const json::exception& error) {
    return invalid_input(fmt::format("job.json: {}", error.what()));
  }
}

Result<JobFile> read_job(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return io_error(fmt::format("{}: {}", path.string(), error.message()));
  if (size > kMaxJobFileBytes)
    return invalid_input(fmt::format("{}: {} bytes are too many", path.string(), size));
  std::ifstream in(path);
  const json document = json::parse(in, nullptr, false);
  if (document.is_discarded()) return invalid_input(fmt::format("{}: not JSON", path.string()));
  return parse_job(document);
}

}  // namespace skinframe
