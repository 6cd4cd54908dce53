// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/assignment.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace skinframe::agent {
namespace {

using nlohmann::json;

// Each returns nullptr for a value that this version does not know: a newer server may send one.
const char* name_of(v1::PrintProcess process) {
  switch (process) {
    case v1::PRINT_PROCESS_POWDER:
      return "powder";
    case v1::PRINT_PROCESS_EXTRUSION:
      return "extrusion";
    case v1::PRINT_PROCESS_RESIN:
      return "resin";
    default:
      return nullptr;
  }
}

const char* name_of(v1::BuildDirection direction) {
  switch (direction) {
    case v1::BUILD_DIRECTION_UNSPECIFIED:
    case v1::BUILD_DIRECTION_UP:
      return "up";
    case v1::BUILD_DIRECTION_HANGING:
      return "hanging";
    default:
      return nullptr;
  }
}

const char* name_of(v1::Axis axis) {
  switch (axis) {
    case v1::AXIS_X:
      return "x";
    case v1::AXIS_Y:
      return "y";
    case v1::AXIS_UNSPECIFIED:
    case v1::AXIS_Z:
      return "z";
    default:
      return nullptr;
  }
}

const char* name_of(v1::Balance balance) {
  switch (balance) {
    case v1::BALANCE_UNSPECIFIED:
    case v1::BALANCE_AUTO:
      return "auto";
    case v1::BALANCE_REQUIRE:
      return "require";
    case v1::BALANCE_OFF:
      return "off";
    default:
      return nullptr;
  }
}

const char* name_of(v1::Smooth smooth) {
  switch (smooth) {
    case v1::SMOOTH_UNSPECIFIED:
    case v1::SMOOTH_AUTO:
      return "auto";
    case v1::SMOOTH_ON:
      return "on";
    case v1::SMOOTH_OFF:
      return "off";
    default:
      return nullptr;
  }
}

const char* name_of(v1::Orient orient) {
  switch (orient) {
    case v1::ORIENT_UNSPECIFIED:
    case v1::ORIENT_KEEP:
      return "keep";
    case v1::ORIENT_BEST:
      return "best";
    default:
      return nullptr;
  }
}

std::optional<bool> is_on(v1::Verify verify) {
  switch (verify) {
    case v1::VERIFY_UNSPECIFIED:
    case v1::VERIFY_ON:
      return true;
    case v1::VERIFY_OFF:
      return false;
    default:
      return std::nullopt;
  }
}

const char* name_of(v1::StageOrder order) {
  switch (order) {
    case v1::STAGE_ORDER_UNSPECIFIED:
    case v1::STAGE_ORDER_TIGHT:
      return "tight";
    case v1::STAGE_ORDER_PAPER:
      return "paper";
    default:
      return nullptr;
  }
}

const char* name_of(v1::Place place) {
  switch (place) {
    case v1::PLACE_TOP:
      return "top";
    case v1::PLACE_BOTTOM:
      return "bottom";
    case v1::PLACE_LEFT:
      return "left";
    case v1::PLACE_RIGHT:
      return "right";
    case v1::PLACE_FRONT:
      return "front";
    case v1::PLACE_BACK:
      return "back";
    default:
      return nullptr;
  }
}

template <class T>
json or_null(bool present, T value) {
  return present ? json(value) : json(nullptr);
}

json printable_length_json(const v1::PrintableLength& curve) {
  json points = json::array();
  for (const auto& point : curve.points())
    points.push_back(
        {{"angle_deg", point.angle_deg()}, {"length_mm", or_null(point.has_length_mm(), point.length_mm())}});
  return {{"points", std::move(points)}, {"is_default", curve.is_default()}, {"source", curve.source()}};
}

json xyz(const v1::Vec3& v) { return {v.x(), v.y(), v.z()}; }

Result<json> printer_json(const v1::PrinterProfile& printer, const v1::MaterialProfile& material) {
  const char* process = name_of(printer.process());
  if (process == nullptr) {
    return internal_error(fmt::format("printer {}: print process {} is unknown to this worker", printer.id(),
                                      static_cast<int>(printer.process())));
  }
  const char* direction = name_of(printer.build_direction());
  if (direction == nullptr) {
    return internal_error(fmt::format("printer {}: build direction {} is unknown to this worker",
                                      printer.id(), static_cast<int>(printer.build_direction())));
  }
  json p = {{"id", printer.id()},
            {"process", process},
            {"min_radius_mm", printer.min_radius_mm()},
            {"tray_mm", {printer.tray_x_mm(), printer.tray_y_mm(), printer.tray_z_mm()}},
            {"max_internal_radius_mm", printer.max_internal_radius_mm()},
            {"printable_length", nullptr},
            {"drain_holes", nullptr},
            {"build_direction", direction},
            {"neck_diameter_mm", or_null(printer.has_neck_diameter_mm(), printer.neck_diameter_mm())}};
  if (printer.has_printable_length())
    p["printable_length"] = printable_length_json(printer.printable_length());
  if (printer.has_drain_holes()) {
    const auto& holes = printer.drain_holes();
    p["drain_holes"] = {
        {"diameter_mm", holes.diameter_mm()},
        {"least_count", holes.least_count()},
        {"least_diameter_mm", or_null(holes.has_least_diameter_mm(), holes.least_diameter_mm())}};
  }
  json m = {
      {"id", material.id()},
      {"tensile_modulus_mpa", material.tensile_modulus_mpa()},
      {"shear_modulus_mpa", material.shear_modulus_mpa()},
      {"tensile_strength_mpa", or_null(material.has_tensile_strength_mpa(), material.tensile_strength_mpa())},
      {"shear_strength_mpa", or_null(material.has_shear_strength_mpa(), material.shear_strength_mpa())},
      {"slenderness", or_null(material.has_slenderness(), material.slenderness())},
      {"density_g_cm3", material.density_g_cm3()},
      {"price_per_kg", or_null(material.has_price_per_kg(), material.price_per_kg())}};
  return json{{"printer", std::move(p)}, {"material", std::move(m)}};
}

Result<json> load_json(const v1::Load& load) {
  constexpr double kDefaultRadiusMm = 5.0;
  json out = {{"name", load.name()},
              {"place", nullptr},
              {"point_mm", nullptr},
              {"force_n", xyz(load.force_n())},
              {"radius_mm", load.radius_mm() == 0.0 ? kDefaultRadiusMm : load.radius_mm()}};
  if (load.has_point_mm()) {
    out["point_mm"] = xyz(load.point_mm());
  } else if (const char* place = name_of(load.place()); place != nullptr) {
    out["place"] = place;
  } else {
    return internal_error(fmt::format("load {}: its place is unknown to this worker", load.name()));
  }
  return out;
}

Result<json> options_json(const v1::JobOptions& o) {
  constexpr double kDefaultDisplacementLimitMm = 0.05;  // epsilon in eq. 6
  const char* up = name_of(o.up());
  const char* balance = name_of(o.balance());
  const char* smooth = name_of(o.smooth());
  const char* orient = name_of(o.orient());
  const char* order = name_of(o.order());
  const std::optional<bool> verify = is_on(o.verify());
  if (!up || !balance || !smooth || !orient || !order || !verify) {
    return internal_error("an option of the job has a value that is unknown to this worker");
  }
  return json{{"up", up},
              {"balance", balance},
              {"size_mm", or_null(o.has_size_mm(), o.size_mm())},
              {"skin_nodes", or_null(o.has_skin_nodes(), o.skin_nodes())},
              {"internal_nodes", or_null(o.has_internal_nodes(), o.internal_nodes())},
              {"voxel_mm", or_null(o.has_voxel_mm(), o.voxel_mm())},
              {"smooth", smooth},
              {"orient", orient},
              {"no_optimize", o.no_optimize()},
              {"verify", *verify},
              {"order", order},
              {"displacement_limit_mm",
               o.has_displacement_limit_mm() ? o.displacement_limit_mm() : kDefaultDisplacementLimitMm},
              {"seed", o.has_seed() ? o.seed() : std::uint64_t{1}}};
}

std::string text_of(const json& request) {
  return request.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace

const std::string& input_sha256(const v1::JobSpec& spec) {
  return spec.has_frame_problem_sha256() ? spec.frame_problem_sha256() : spec.mesh_sha256();
}

std::map<std::string, v1::ResultFile> choose_warm_start_files(const v1::Assignment& assignment) {
  constexpr std::size_t kMostFiles = 16;  // printers of a job
  constexpr std::string_view kName = "/initial-frame.json";
  std::map<std::string, v1::ResultFile> chosen;
  for (const v1::ResultFile& file : assignment.warm_start_files()) {
    const std::string_view path = file.path();
    if (!path.ends_with(kName) || chosen.size() == kMostFiles) continue;
    chosen.emplace(path.substr(0, path.size() - kName.size()), file);
  }
  return chosen;
}

Result<std::string> job_request_json(const v1::Assignment& assignment,
                                     const std::filesystem::path& input_path,
                                     const std::map<std::string, std::filesystem::path>& warm_start_files,
                                     int threads) {
  const v1::JobSpec& spec = assignment.spec();
  if (spec.has_frame_problem_sha256()) {
    return text_of({{"job_id", assignment.job_id()},
                    {"frame_problem_path", input_path.string()},
                    {"mesh_name", spec.mesh_name()},
                    {"threads", threads}});
  }
  if (!spec.has_mesh_sha256()) return unsupported("this worker takes meshes and frame problem files only");
  if (spec.printers_size() == 0 || assignment.printers_size() != spec.printers_size() ||
      assignment.materials_size() != spec.printers_size()) {
    return internal_error(
        fmt::format("the assignment has {} printer and {} material profiles for {} printers",
                    assignment.printers_size(), assignment.materials_size(), spec.printers_size()));
  }
  json printers = json::array();
  for (int i = 0; i < assignment.printers_size(); ++i) {
    auto printer = printer_json(assignment.printers(i), assignment.materials(i));
    if (!printer) return printer.error();
    printers.push_back(std::move(printer).value());
  }
  json loads = json::array();
  for (const v1::Load& each : spec.loads()) {
    auto load = load_json(each);
    if (!load) return load.error();
    loads.push_back(std::move(load).value());
  }
  auto options = options_json(spec.options());
  if (!options) return options.error();
  json request = {{"job_id", assignment.job_id()},
                  {"mesh_path", input_path.string()},
                  {"mesh_name", spec.mesh_name()},
                  {"printers", std::move(printers)},
                  {"loads", std::move(loads)},
                  {"options", std::move(options).value()},
                  {"threads", threads}};
  if (!spec.warm_start_job_id().empty()) {
    json files = json::object();
    for (const auto& [printer, path] : warm_start_files) files[printer] = path.string();
    request["warm_start"] = {{"job_id", spec.warm_start_job_id()}, {"files", std::move(files)}};
  }
  return text_of(request);
}

}  // namespace skinframe::agent
