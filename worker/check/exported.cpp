// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported.h"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "worker/check/exported_orientation.h"
#include "worker/check/exported_stages.h"
#include "worker/check/exported_supports.h"
#include "worker/mesh/read_mesh.h"

namespace skinframe::check {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{1} << 30;

Result<json> read_json(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return io_error(fmt::format("{}: {}", path.string(), error.message()));
  if (size > kMaxJsonBytes)
    return invalid_input(fmt::format("{}: {} bytes are too many", path.string(), size));
  std::ifstream in(path);
  json document = json::parse(in, nullptr, false);
  if (document.is_discarded()) return invalid_input(fmt::format("{}: not JSON", path.string()));
  return document;
}

Eigen::Vector3d vector3(const json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

std::optional<double> optional_number(const json& object, const char* key) {
  const auto it = object.find(key);
  if (it == object.end() || it->is_null()) return std::nullopt;
  return it->get<double>();
}

// Throws std::out_of_range with the place of an index that names nothing.
int node_index(const json& value, std::size_t count, const std::string& place) {
  const auto index = value.get<long long>();
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw std::out_of_range(fmt::format("{}: {} is not a node (0..{})", place, index, count - 1));
  return static_cast<int>(index);
}

// A problem file has no radii yet.
enum class Radii { kGiven, kNone };

ExportedFrame parse_frame(const json& file, Radii radii = Radii::kGiven) {
  ExportedFrame frame;
  const json& material = file.at("material");
  frame.tensile_modulus_mpa = material.at("tensile_modulus_mpa").get<double>();
  const auto mechanics = file.at("mechanics").get<std::string>();
  if (mechanics != "paper" && mechanics != "axial")
    throw std::out_of_range(fmt::format("mechanics \"{}\" is not known to this check", mechanics));
  frame.axial = mechanics == "axial";
  frame.shear_modulus_mpa = frame.axial ? 0.0 : material.at("shear_modulus_mpa").get<double>();
  frame.density_g_cm3 = material.at("density_g_cm3").get<double>();
  frame.tensile_strength_mpa = optional_number(material, "tensile_strength_mpa");
  frame.shear_strength_mpa = optional_number(material, "shear_strength_mpa");
  frame.slenderness = optional_number(material, "slenderness");
  frame.displacement_limit_mm = optional_number(file, "displacement_limit_mm");

  for (const json& node : file.at("nodes")) frame.nodes_mm.push_back(vector3(node));
  const std::size_t n = frame.nodes_mm.size();
  for (const json& item : file.at("struts")) {
    const std::string place = fmt::format("struts[{}]", frame.struts.size());
    ExportedStrut strut;
    strut.a = node_index(item.at("a"), n, place + ".a");
    strut.b = node_index(item.at("b"), n, place + ".b");
    strut.skin = item.at("skin").get<bool>();
    if (radii == Radii::kGiven) strut.radius_mm = item.at("radius_mm").get<double>();
    strut.min_radius_mm = item.at("min_radius_mm").get<double>();
    strut.max_radius_mm = item.at("max_radius_mm").get<double>();
    frame.struts.push_back(strut);
  }
  for (const json& item : file.value("skin_triangles", json::array())) {
    const std::string place = fmt::format("skin_triangles[{}]", frame.skin_triangles.size());
    frame.skin_triangles.push_back({node_index(item.at(0), n, place), node_index(item.at(1), n, place),
                                    node_index(item.at(2), n, place)});
  }
  frame.fixed.assign(n, {false, false, false});
  if (n == 0) return frame;
  for (const json& item : file.at("fixed")) {
    const int node = node_index(item.at("node"), n, "fixed.node");
    for (const char axis : item.at("axes").get<std::string>())
      if (axis >= 'x' && axis <= 'z') frame.fixed[node][axis - 'x'] = true;
  }
  frame.skin_weight_n.assign(n, 0.0);
  if (file.contains("skin_weight_n"))
    for (std::size_t i = 0; i < n; ++i) frame.skin_weight_n[i] = file.at("skin_weight_n").at(i).get<double>();
  if (file.contains("skin_mass")) {
    frame.skin_mass_weight_n = file.at("skin_mass").at("weight_n").get<double>();
    frame.skin_centroid_mm = vector3(file.at("skin_mass").at("centroid_mm"));
  }
  if (file.contains("balance_half_planes"))
    for (const json& plane : file.at("balance_half_planes"))
      frame.balance_half_planes.emplace_back(
          Eigen::Vector2d(plane.at("normal").at(0).get<double>(), plane.at("normal").at(1).get<double>()),
          plane.at("offset_mm").get<double>());
  for (const json& item : file.at("load_cases")) {
    ExportedLoadCase load_case;
    load_case.name = item.at("name").get<std::string>();
    load_case.gravity = item.at("gravity").get<bool>();
    load_case.force_n.assign(n, Eigen::Vector3d::Zero());
    for (const json& force : item.at("forces"))
      load_case.force_n[node_index(force.at("node"), n, "forces.node")] += vector3(force.at("force_n"));
    if (item.contains("displacements_mm"))
      for (const json& displacement : item.at("displacements_mm"))
        load_case.displacement_mm.push_back(vector3(displacement));
    frame.load_cases.push_back(std::move(load_case));
  }
  return frame;
}

std::optional<ExportedProof> parse_proof(const json& file, const char* key, const ExportedFrame& frame) {
  if (!file.contains(key) || file.at(key).is_null()) return std::nullopt;
  const json& item = file.at(key);
  ExportedProof proof;
  proof.volume_weight = item.at("volume_weight").get<double>();
  proof.feasibility_tolerance = item.at("feasibility_tolerance").get<double>();
  proof.value = item.at("value").get<double>();
  proof.removable_may_vanish = item.at("radii").get<std::string>() == "removable_may_vanish";
  proof.balance_multipliers = item.at("balance_multipliers").get<std::vector<double>>();
  const std::size_t planes = proof.balance_multipliers.size();
  if (planes != 0 && planes != frame.balance_half_planes.size())
    throw std::out_of_range(fmt::format("{}: {} balance multipliers for {} half planes", key, planes,
                                        frame.balance_half_planes.size()));
  for (const json& entry : item.at("fields")) {
    ExportedField field;
    const auto load_case = entry.at("load_case").get<long long>();
    if (load_case < 0 || static_cast<std::size_t>(load_case) >= frame.load_cases.size())
      throw std::out_of_range(fmt::format("{}: {} is not a load case", key, load_case));
    field.load_case = static_cast<int>(load_case);
    field.displacement_multiplier = entry.at("displacement_multiplier").get<double>();
    field.stress_multiplier = entry.at("stress_multiplier").get<double>();
    for (const json& d : entry.at("displacements_mm")) field.displacement_mm.push_back(vector3(d));
    if (field.displacement_mm.size() != frame.nodes_mm.size())
      throw std::out_of_range(fmt::format("{}: {} displacements for {} nodes", key,
                                          field.displacement_mm.size(), frame.nodes_mm.size()));
    proof.fields.push_back(std::move(field));
  }
  return proof;
}

void parse_bounds(const json& item, ExportedPrinter* out) {
  out->lower_bound_mm3 = optional_number(item, "lower_bound_mm3");
  out->gap = optional_number(item, "gap");
  out->relaxed_lower_bound_mm3 = optional_number(item, "relaxed_lower_bound_mm3");
  out->relaxed_gap = optional_number(item, "relaxed_gap");
}

ExportedPrinter parse_printer(const json& item) {
  ExportedPrinter out;
  out.printer = item.at("printer").get<std::string>();
  out.material = item.at("material").get<std::string>();
  out.termination = item.at("termination").at("reason").get<std::string>();
  const json& profile = item.at("profile");
  out.eta_mm = profile.at("min_radius_mm").get<double>();
  out.skin_thickness_mm = profile.at("skin_thickness_mm").get<double>();
  out.max_internal_radius_mm = profile.at("max_internal_radius_mm").get<double>();
  out.density_g_cm3 = profile.at("density_g_cm3").get<double>();
  out.tray_mm = vector3(profile.at("tray_mm"));
  out.best_reachable_displacement_mm = optional_number(item, "best_reachable_displacement_mm");
  out.solid_volume_mm3 = item.at("solid_volume_mm3").get<double>();
  out.skin_volume_mm3 = item.at("skin_volume_mm3").get<double>();
  out.frame_volume_mm3 = item.at("frame_volume_mm3").get<double>();
  out.total_volume_mm3 = item.at("total_volume_mm3").get<double>();
  out.ratio = item.at("ratio").get<double>();
  out.size_volume_mm3 = item.at("size_volume_mm3").get<double>();
  out.topology_volume_mm3 = item.at("topology_volume_mm3").get<double>();
  out.geometry_volume_mm3 = item.at("geometry_volume_mm3").get<double>();
  out.max_displacement_mm = item.at("max_displacement_mm").get<double>();
  out.max_axial_ratio = item.at("max_axial_ratio").get<double>();
  out.max_shear_ratio = item.at("max_shear_ratio").get<double>();
  out.min_radius_mm = item.at("min_radius_mm").get<double>();
  out.balance = item.at("balance").get<std::string>();
  out.violated_constraint = item.value("violated_constraint", "");
  out.balance_margin_mm = optional_number(item, "balance_margin_mm");
  out.printed_balance_margin_mm = optional_number(item, "printed_balance_margin_mm");
  parse_bounds(item, &out);
  out.infeasibility_proven = item.value("infeasibility_proven", false);
  if (item.contains("smoothing") && item.at("smoothing").at("applied").get<bool>())
    out.added_skin_mm3 = item.at("smoothing").at("added_skin_mm3").get<double>();
  if (item.contains("sampling"))
    out.skin_struts_outside = item.at("sampling").at("skin_struts_outside").get<int>();
  out.final_nodes = item.at("counts").at("geometry").at("nodes").get<int>();
  out.final_struts = item.at("counts").at("geometry").at("struts").get<int>();
  if (item.contains("verification")) out.verification = parse_verification(item.at("verification"));
  if (!out.infeasible()) {
    out.printed_volume_mm3 = item.at("printed_volume_mm3").get<double>();
    out.printed_ratio = item.at("printed_ratio").get<double>();
    out.weight_g = item.at("weight_g").get<double>();
    out.voxel_mm = item.at("voxel_mm").get<double>();
  }
  return out;
}

ExportedPrinter parse_solution(const json& item) {
  ExportedPrinter figures;
  figures.printer = "frame";
  const json& termination = item.at("termination");
  figures.termination =
      termination.at("reason").get<std::string>() == "infeasible" ? "INFEASIBLE" : "OPTIMAL";
  figures.violated_constraint = termination.value("violated_constraint", "");
  figures.best_reachable_displacement_mm = optional_number(termination, "best_reachable_displacement_mm");
  const json& volumes = item.at("volumes_mm3");
  figures.size_volume_mm3 = volumes.at("size").get<double>();
  figures.topology_volume_mm3 = volumes.at("topology").get<double>();
  figures.geometry_volume_mm3 = volumes.at("geometry").get<double>();
  figures.final_nodes = item.at("counts").at("geometry").at("nodes").get<int>();
  figures.final_struts = item.at("counts").at("geometry").at("struts").get<int>();
  parse_bounds(item, &figures);
  figures.infeasibility_proven = item.contains("certificate") && !item.at("certificate").is_null();
  const json& evaluation = item.at("evaluation");
  figures.frame_volume_mm3 = evaluation.at("frame_volume_mm3").get<double>();
  figures.max_displacement_mm = optional_number(evaluation, "max_displacement_mm").value_or(0.0);
  figures.max_axial_ratio = optional_number(evaluation, "max_axial_ratio").value_or(0.0);
  figures.max_shear_ratio = optional_number(evaluation, "max_shear_ratio").value_or(0.0);
  figures.min_radius_mm = evaluation.at("min_radius_mm").get<double>();
  figures.balance_margin_mm = optional_number(evaluation, "balance_margin_mm");
  return figures;
}

// The frame that was optimised, and what proves the bounds on its volume.
void read_given(const json& given, const json& proofs, ExportedPrinter* out) {
  out->given = parse_frame(given, Radii::kNone);
  out->bound_proof = parse_proof(proofs, "lower_bound_proof", *out->given);
  out->relaxed_bound_proof = parse_proof(proofs, "relaxed_lower_bound_proof", *out->given);
}

// One of the printer's further files; files that make no claim of their own are passed over.
Status read_listed(const std::filesystem::path& path, const json& item, ExportedPrinter* printer,
                   RunContext& context) {
  const std::string name = path.filename().string();
  if (name == "skin-frame-compact.stl") {
    auto file = read_mesh(path, ReadLimits{}, context);
    if (!file) return file.error();
    printer->compact = weld_equal(file->mesh);
    const json& compact = item.at("compact");
    printer->compact_crossings = compact.value("crossings", std::size_t{0});
    printer->compact_triangles = compact.at("triangles").get<std::size_t>();
    printer->compact_volume_mm3 = compact.at("volume_mm3").get<double>();
    printer->compact_deviation_mm = compact.at("deviation_mm").get<double>();
  } else if (name == "skin-frame.3mf" || name == "frame-beams.3mf") {
    auto package = read_package(path);
    if (!package) return package.error();
    (name == "skin-frame.3mf" ? printer->package : printer->beams) = std::move(package).value();
  } else if (name == "initial-frame.json") {
    auto initial = read_json(path);
    if (!initial) return initial.error();
    if (!printer->lower_bound_mm3 && !printer->relaxed_lower_bound_mm3) return ok_status();
    read_given(*initial, *initial, printer);
  } else if (name.starts_with("deformation-") && printer->verification) {
    auto deformation = read_deformation(path);
    if (!deformation) return deformation.error();
    printer->verification->deformations.push_back(std::move(deformation).value());
  } else if (name.starts_with("hole-") && printer->drain) {
    auto file = read_mesh(path, ReadLimits{}, context);
    if (!file) return file.error();
    (name == "hole-lids.stl" ? printer->drain->lids_mesh : printer->drain->caps_mesh) =
        weld_equal(file->mesh);
  } else if (name == "pinch.ply" && printer->verification) {
    auto pinch = read_pinch(path);
    if (!pinch) return pinch.error();
    printer->verification->pinch = std::move(pinch).value();
  } else if (name.starts_with("support-struts") && printer->supports) {
    auto file = read_mesh(path, ReadLimits{}, context);
    if (!file) return file.error();
    ExportedSupports& supports = *printer->supports;
    (name == "support-struts-internal.stl"   ? supports.internal_mesh
     : name == "support-struts-external.stl" ? supports.external_mesh
                                             : supports.all_mesh) = weld_equal(file->mesh);
  }
  return ok_status();
}

}  // namespace

TriangleMesh weld_equal(const TriangleMesh& soup) {
  TriangleMesh welded;
  std::map<std::array<double, 3>, int> index_of;
  std::vector<int> renamed(soup.vertices.size());
  for (std::size_t i = 0; i < soup.vertices.size(); ++i) {
    const Eigen::Vector3d& v = soup.vertices[i];
    const auto [it, fresh] =
        index_of.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(welded.vertices.size()));
    if (fresh) welded.vertices.push_back(v);
    renamed[i] = it->second;
  }
  welded.triangles.reserve(soup.triangles.size());
  for (const auto& t : soup.triangles)
    welded.triangles.push_back({renamed[t[0]], renamed[t[1]], renamed[t[2]]});
  return welded;
}

Result<Exported> read_exported(const std::filesystem::path& directory, RunContext& context) {
  const auto report_path = directory / "report.json";
  auto report = read_json(report_path);
  if (!report) return report.error();
  std::vector<ExportedPrinter> printers;
  std::optional<ExportedOrientation> orientation;
  std::filesystem::path reading = report_path;
  try {
    if (report->contains("frame")) {
      ExportedPrinter solution = parse_solution(report->at("frame"));
      reading = directory / "result.json";
      auto frame = read_json(reading);
      if (!frame) return frame.error();
      solution.frame = parse_frame(*frame);
      solution.certificate = parse_proof(*frame, "certificate", solution.frame);
      solution.stages = parse_stages(*frame, report->at("frame").at("counts"));
      report_volumes(&solution, report->at("frame").at("volumes_mm3").at("initial").get<double>());
      if (frame->contains("given")) read_given(frame->at("given"), *frame, &solution);
      return Exported{{}, std::nullopt, std::move(solution)};
    }
    orientation = parse_orientation(report->at("mesh"));
    for (const json& item : report->at("printers")) {
      reading = report_path;
      // A printer that was refused before it had a frame (does not fit, for example) claims nothing.
      if (!item.contains("termination")) continue;
      ExportedPrinter printer = parse_printer(item);
      printer.solid_triangles = report->at("mesh").at("triangles").get<std::size_t>();
      if (item.contains("drain_holes")) {
        printer.drain = parse_drain(item.at("drain_holes"));
        printer.solid_triangles = printer.drain->outer_triangles;
      }
      printer.crossings = item.value("crossings", std::size_t{0});
      const auto folder = directory / printer.printer;
      if (!printer.solid()) {
        reading = folder / "frame.json";
        auto frame = read_json(reading);
        if (!frame) return frame.error();
        printer.frame = parse_frame(*frame);
        printer.certificate = parse_proof(*frame, "certificate", printer.frame);
        printer.stages = parse_stages(*frame, item.at("counts"));
        report_volumes(&printer, std::nullopt);
        if (item.contains("supports") && frame->contains("supports"))
          printer.supports = parse_supports(frame->at("supports"), item.at("supports"),
                                            printer.frame.nodes_mm.size(), printer.frame.struts.size());
      }
      if (!printer.infeasible()) {
        auto merged = read_mesh(folder / "skin-frame.stl", ReadLimits{}, context);
        if (!merged) return merged.error();
        printer.merged = weld_equal(merged->mesh);
      }
      for (const json& file : item.value("files", json::array())) {
        reading = folder / file.get<std::string>();
        if (auto read = read_listed(reading, item, &printer, context); !read) return read.error();
      }
      printers.push_back(std::move(printer));
    }
  } catch (const std::exception& error) {
    return invalid_input(fmt::format("{}: {}", reading.string(), error.what()));
  }
  if (printers.empty())
    return invalid_input(fmt::format("{}: no printer in it has a result to check", report_path.string()));
  return Exported{std::move(printers), std::move(orientation), std::nullopt};
}

}  // namespace skinframe::check
